// SPDX-License-Identifier: Apache-2.0
#include "files/alembic/ogawa_writer.h"

#include "files/byte_order.h"

namespace sac {
namespace {

constexpr std::uint64_t kDataBit = std::uint64_t{1} << 63;

std::string Number(std::uint64_t value) {
  std::string bytes(8, '\0');
  StoreLittle64(value, bytes.data());
  return bytes;
}

}  // namespace

Status OgawaWriter::Open(const std::string& path) {
  SAC_RETURN_IF_ERROR(file_.Open(path));
  if (!file_.seekable()) {
    return Status::InvalidArgument(path + ": an Alembic file cannot be written to a pipe or a device");
  }
  using std::string_view_literals::operator""sv;
  // The byte after the name says that the file is not whole yet.
  return Append("Ogawa\0\0\1\0\0\0\0\0\0\0\0"sv);
}

Status OgawaWriter::Append(std::string_view bytes) {
  size_ += bytes.size();
  return file_.Write(bytes.data(), bytes.size());
}

Status OgawaWriter::WriteData(std::string_view bytes, OgawaRef& ref) {
  ref.bits = kDataBit;
  if (bytes.empty()) return Status::Ok();
  ref.bits |= size_;
  SAC_RETURN_IF_ERROR(Append(Number(bytes.size())));
  return Append(bytes);
}

Status OgawaWriter::WriteGroup(const std::vector<OgawaRef>& children, OgawaRef& ref) {
  ref.bits = 0;
  if (children.empty()) return Status::Ok();
  ref.bits = size_;
  std::string bytes = Number(children.size());
  for (const OgawaRef child : children) bytes += Number(child.bits);
  return Append(bytes);
}

Status OgawaWriter::Finish(OgawaRef root) {
  SAC_RETURN_IF_ERROR(file_.WriteAt(8, Number(root.bits).data(), 8));
  SAC_RETURN_IF_ERROR(file_.WriteAt(5, "\xFF", 1));
  return file_.Close();
}

}  // namespace sac
