// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "files/alembic/ogawa_reader.h"
#include "files/output_file.h"
#include "sac/status.h"

namespace sac {

// Writes an Ogawa file (files/alembic/ogawa_reader.h) from its leaves to its root; it appears under its name with
// Commit.
class OgawaWriter {
 public:
  // kInvalidArgument for an output that cannot seek: the root's place in the header is known at the end alone.
  Status Open(const std::string& path);

  // Appends data. Empty data take no room.
  Status WriteData(std::string_view bytes, OgawaRef& ref);
  // Appends a group of what was written before.
  Status WriteGroup(const std::vector<OgawaRef>& children, OgawaRef& ref);

  // Completes the header and closes the file, which keeps its temporary name until Commit.
  Status Finish(OgawaRef root);
  Status Commit() { return file_.Commit(); }

  const std::string& path() const { return file_.path(); }

 private:
  Status Append(std::string_view bytes);

  OutputFile file_;
  std::uint64_t size_ = 0;
};

}  // namespace sac
