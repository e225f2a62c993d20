// SPDX-License-Identifier: Apache-2.0
// Manual pages of what the options say of themselves.
#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>
#include <vector>

#include "cli/reference.h"

namespace sac {
namespace {

// Text as roff prints it: no escape, no request at the begin of a line, hyphens that can be copied as minus signs.
std::string Escaped(const std::string& text) {
  std::string out;
  bool at_begin = true;
  for (const char c : text) {
    if (at_begin && (c == '.' || c == '\'')) out += "\\&";
    at_begin = c == '\n';
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\'') {
      out += "\\(aq";
    } else {
      out += c;
    }
  }
  return out;
}

std::string Upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

std::string OnOneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// What stands for the value of an option, empty for a flag.
std::string ValueName(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return "";
  const std::string text = option.get_option_text();
  if (text != "..." && text != " " && !text.empty()) return text;
  return option.get_positional() ? option.get_single_name() : option.get_type_name();
}

void AddOptions(const CLI::App& app, std::string& page) {
  for (const bool positionals : {true, false}) {
    for (const CLI::Option* option : app.get_options()) {
      if (option->get_positional() != positionals || option->get_group().empty()) continue;
      std::string names;
      if (positionals) {
        names = "\\fI" + Escaped(option->get_single_name()) + "\\fR";
        if (option->get_items_expected_max() > 1) names += "...";
      } else {
        for (const std::string& name : option->get_snames())
          names += (names.empty() ? "" : ", ") + ("\\fB\\-" + name) + "\\fR";
        for (const std::string& name : option->get_lnames()) {
          names += (names.empty() ? "" : ", ") + ("\\fB" + Escaped("--" + name)) + "\\fR";
        }
        const std::string value = ValueName(*option);
        if (!value.empty()) names += " \\fI" + Escaped(value) + "\\fR";
      }
      page += ".TP\n" + names + "\n" + Escaped(OnOneLine(option->get_description())) + "\n";
    }
  }
}

// Paragraphs of a footer. What follows "Example:" is a section of its own, with its line breaks kept.
void AddFooter(const std::string& footer, std::string& page) {
  std::istringstream lines(footer);
  bool in_example = false;
  for (std::string line; std::getline(lines, line);) {
    if (line == "Example:" || line == "Examples:") {
      page += ".SH EXAMPLES\n.nf\n";
      in_example = true;
    } else if (line.empty()) {
      if (!in_example) page += ".PP\n";
    } else {
      const std::size_t text = in_example ? std::min(line.find_first_not_of(' '), line.size()) : 0;
      page += Escaped(line.substr(text)) + "\n";
    }
  }
  if (in_example) page += ".fi\n";
}

std::string Synopsis(const CLI::App& app, const std::string& name) {
  std::string text = ".B " + name + "\n";
  std::string positionals;
  bool has_options = false;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) {
      has_options = true;
      continue;
    }
    const std::string dots = option->get_items_expected_max() > 1 ? "..." : "";
    positionals += " \\fI" + Escaped(option->get_single_name()) + "\\fR" + dots;
  }
  if (has_options) text += "[\\fIOPTIONS\\fR]";
  return text + positionals + "\n";
}

void AddCommands(const CLI::App& app, std::string& page) {
  page += ".SH COMMANDS\n";
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (command->get_group().empty()) continue;
    page += ".TP\n\\fB" + Escaped(command->get_name()) + "\\fR\n" + Escaped(command->get_description()) + "\n";
  }
}

}  // namespace

std::string ManPage(const CLI::App& app, const CLI::App* command, const std::string& version) {
  const CLI::App& described = command != nullptr ? *command : app;
  const std::string dashed = app.get_name() + (command != nullptr ? "-" + command->get_name() : "");
  const std::string spaced = app.get_name() + (command != nullptr ? " " + command->get_name() : "");
  std::string brief = described.get_description().substr(0, described.get_description().find(". "));
  if (!brief.empty() && brief.back() == '.') brief.pop_back();
  brief[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(brief[0])));
  std::string page =
      ".\\\" Made by sac reference.\n.TH " + Upper(dashed) + " 1 \"\" \"" + version + "\" \"User Commands\"\n";
  page += ".SH NAME\n" + Escaped(dashed) + " \\- " + Escaped(brief) + "\n.SH SYNOPSIS\n";
  page += command != nullptr ? Synopsis(described, Escaped(spaced)) : ".B sac\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n";
  page += ".SH DESCRIPTION\n" + Escaped(described.get_description()) + "\n";
  if (command == nullptr) AddCommands(app, page);
  page += ".SH OPTIONS\n";
  AddOptions(described, page);
  const std::string footer = described.get_footer();
  if (!footer.empty()) page += (footer.rfind("Example", 0) == 0 ? "" : ".SH NOTES\n");
  AddFooter(footer, page);
  page +=
      ".SH EXIT STATUS\n0 success, 1 a file, a stream or the disk is at fault, 2 the command line is.\n.SH SEE ALSO\n";
  std::vector<std::string> others;
  if (command != nullptr) others.push_back(app.get_name());
  for (const CLI::App* other : app.get_subcommands(nullptr)) {
    if (other != command && !other->get_group().empty()) others.push_back(app.get_name() + "-" + other->get_name());
  }
  for (const std::string& other : others)
    page += ".BR " + Escaped(other) + (&other == &others.back() ? " (1)\n" : " (1),\n");
  return page;
}

}  // namespace sac
