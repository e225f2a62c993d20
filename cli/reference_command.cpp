// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "cli/commands.h"
#include "cli/reference.h"
#include "files/output_file.h"
#include "sac/version.h"

namespace sac {
namespace {

namespace fs = std::filesystem;

Status WriteText(const fs::path& path, const std::string& text) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) return Status::IoError(path.parent_path().string() + ": " + error.message());
  OutputFile file;
  SAC_RETURN_IF_ERROR(file.Open(path.string()));
  SAC_RETURN_IF_ERROR(file.Write(text));
  return file.Commit();
}

Status WriteReference(const CLI::App& app, const fs::path& folder) {
  const std::string version = "sac " SAC_VERSION_STRING;
  SAC_RETURN_IF_ERROR(WriteText(folder / "man1" / "sac.1", ManPage(app, nullptr, version)));
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (command->get_group().empty()) continue;
    const fs::path page = folder / "man1" / ("sac-" + command->get_name() + ".1");
    SAC_RETURN_IF_ERROR(WriteText(page, ManPage(app, command, version)));
  }
  SAC_RETURN_IF_ERROR(WriteText(folder / "bash" / "sac", BashCompletion(app)));
  return WriteText(folder / "zsh" / "_sac", ZshCompletion(app));
}

}  // namespace

Command AddReferenceCommand(CLI::App& app) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("reference", "Write manual pages and completions into a folder.");
  command->group("");  // for those who make packages
  command->add_option("FOLDER", *folder, "gets man1/*.1, bash/sac and zsh/_sac")->required()->option_text(" ");
  return {command, [] { return Status::Ok(); }, [folder, &app] { return WriteReference(app, *folder); }};
}

}  // namespace sac
