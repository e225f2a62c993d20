// SPDX-License-Identifier: Apache-2.0
// Completions of what the options say of themselves.
#include <algorithm>
#include <string>
#include <vector>

#include "cli/reference.h"

namespace sac {
namespace {

// The words that an option takes, empty where it takes others: a validator lists them in braces.
std::vector<std::string> Choices(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  std::vector<std::string> words;
  if (begin == std::string::npos || end == std::string::npos || end < begin) return words;
  for (std::size_t at = begin + 1; at <= end;) {
    const std::size_t next = std::min(type.find(',', at), end);
    words.push_back(type.substr(at, next - at));
    at = next + 1;
  }
  return words;
}

bool TakesValue(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

// Whether the value of an option may be a file's name: numbers and other words have no type name of text.
bool TakesFile(const CLI::Option& option) {
  const std::string text = option.get_option_text();
  return option.get_positional() || text == "FILE" || text == "OUT" || text == "DECODED..." || text == "PICTURE";
}

std::vector<std::string> NamesOf(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::string Joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::vector<const CLI::App*> Commands(const CLI::App& app) {
  std::vector<const CLI::App*> commands;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (!command->get_group().empty()) commands.push_back(command);
  }
  return commands;
}

std::string OptionWords(const CLI::App& app) {
  std::vector<std::string> words;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : NamesOf(*option)) words.push_back(name);
  }
  return Joined(words, " ");
}

// The lines of a bash function for one command: what may follow the word before, else options, choices or files.
std::string BashCase(const CLI::App& command) {
  std::string lines =
      "    " + command.get_name() + ")\n      options='" + OptionWords(command) + "'\n      case $previous in\n";
  std::string positional_choices;
  for (const CLI::Option* option : command.get_options()) {
    const std::vector<std::string> choices = Choices(*option);
    if (option->get_positional()) {
      if (!choices.empty()) positional_choices = Joined(choices, " ");
      continue;
    }
    if (!TakesValue(*option)) continue;
    const std::string names = Joined(NamesOf(*option), "|");
    if (!choices.empty()) {
      lines += "        " + names + ") words='" + Joined(choices, " ") + "' ;;\n";
    } else if (!TakesFile(*option)) {
      lines += "        " + names + ") return ;;\n";
    }
  }
  lines += "      esac\n";
  if (!positional_choices.empty())
    lines += "      [[ $COMP_CWORD -eq 2 && $current != -* ]] && words='" + positional_choices + "'\n";
  return lines + "      ;;\n";
}

// Text within the brackets and colons of a specification of zsh, in single quotes.
std::string ZshEscaped(std::string text) {
  std::string out;
  std::replace(text.begin(), text.end(), '\n', ' ');
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
      out += c;
    }
  }
  return out;
}

std::string ZshValue(const CLI::Option& option) {
  const std::vector<std::string> choices = Choices(option);
  const std::string name = ZshEscaped(option.get_option_text().empty() ? "value" : option.get_option_text());
  if (!choices.empty()) return ":" + name + ":(" + Joined(choices, " ") + ")";
  return ":" + name + ":" + (TakesFile(option) ? "_files" : "");
}

std::string ZshOption(const CLI::Option& option) {
  if (option.get_positional()) {
    const std::string many = option.get_items_expected_max() > 1 ? "*" : "";
    const std::vector<std::string> choices = Choices(option);
    const std::string what = choices.empty() ? "_files" : "(" + Joined(choices, " ") + ")";
    return "        '" + many + ":" + ZshEscaped(option.get_single_name()) + ":" + what + "'";
  }
  const std::vector<std::string> names = NamesOf(option);
  const std::string value = TakesValue(option) ? ZshValue(option) : "";
  const std::string description = "[" + ZshEscaped(option.get_description()) + "]" + value + "'";
  if (names.size() == 1) return "        '" + names[0] + description;
  return "        '(" + Joined(names, " ") + ")'{" + Joined(names, ",") + "}'" + description;
}

}  // namespace

std::string BashCompletion(const CLI::App& app) {
  std::vector<std::string> commands;
  for (const CLI::App* command : Commands(app)) commands.push_back(command->get_name());
  std::string text =
      "# Made by sac reference.\n"
      "_sac() {\n"
      "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} options='' words=''\n"
      "  COMPREPLY=()\n"
      "  if [[ $COMP_CWORD -eq 1 ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W '" +
      Joined(commands, " ") + " " + OptionWords(app) +
      "' -- \"$current\")\n    return\n  fi\n  case ${COMP_WORDS[1]} in\n";
  for (const CLI::App* command : Commands(app)) text += BashCase(*command);
  return text +
         "    *) return ;;\n"
         "  esac\n"
         "  [[ -z $words && $current == -* ]] && words=$options\n"
         "  if [[ -n $words ]]; then\n"
         "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
         "  else\n"
         "    compopt -o filenames 2>/dev/null\n"
         "    mapfile -t COMPREPLY < <(compgen -f -- \"$current\")\n"
         "  fi\n"
         "}\n"
         "complete -F _sac sac\n";
}

std::string ZshCompletion(const CLI::App& app) {
  std::string text =
      "#compdef sac\n"
      "# Made by sac reference.\n"
      "_sac() {\n"
      "  local line state\n"
      "  _arguments -C '1:command:->command' '*::argument:->argument'\n"
      "  case $state in\n"
      "    command)\n"
      "      local -a commands=(\n";
  for (const CLI::App* command : Commands(app)) {
    text += "        '" + command->get_name() + ":" + ZshEscaped(command->get_description()) + "'\n";
  }
  text += "      )\n      _describe command commands\n      ;;\n    argument)\n      case $line[1] in\n";
  for (const CLI::App* command : Commands(app)) {
    text += "        " + command->get_name() + ")\n          _arguments";
    for (const CLI::Option* option : command->get_options()) text += " \\\n    " + ZshOption(*option);
    text += "\n          ;;\n";
  }
  return text + "      esac\n      ;;\n  esac\n}\n_sac \"$@\"\n";
}

}  // namespace sac
