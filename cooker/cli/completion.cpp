// SPDX-License-Identifier: MIT
// The scripts walk the words before the cursor as CLI11 does: options, their values, commands, and
// positionals by number. What there is at each place, they have in tables that are made here.
#include "cooker/cli/completion.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/import.h"
#include "cooker/text/nearest_name.h"

namespace boxtree::cooker {
namespace {

// A command, and what may follow its name.
struct Place {
  std::string path;  // "query ray"; empty for the program
  std::vector<const Command*> commands;
  std::vector<OptionText> options;  // a kind takes those of its command, too
  std::vector<OptionText> positionals;
  std::size_t commands_after = 0;  // how many positionals come before a command
};

std::string path_below(const std::string& path, const Command& command) {
  return path + (path.empty() ? "" : " ") + command.name();
}

// What `help` takes, "help query ray", as if commands were its own.
void add_names(const Command& command, const Place& of, std::vector<Place>& places) {
  for (const Command* inner : command.commands()) {
    Place place{path_below(of.path, *inner), inner->commands(), of.options, {}};
    places.push_back(place);
    add_names(*inner, place, places);
  }
}

void add_places(const Command& program, const Command& command, const std::string& path,
                const std::vector<OptionText>& inherited, std::vector<Place>& places) {
  Place place{path, command.commands(), options_of(command), {}};
  const std::vector<OptionText> own = place.options;
  for (const OptionText& option : inherited) {
    bool is_own = false;
    for (const OptionText& other : own) is_own = is_own || other.names == option.names;
    if (!is_own) place.options.push_back(option);
  }
  for (const OptionText& positional : positionals_of(command)) {
    if (positional.facts.values == Values::kCommands) {
      place.commands = program.commands();
      places.push_back(place);
      return add_names(program, place, places);
    }
    place.positionals.push_back(positional);
  }
  place.commands_after = place.positionals.size();
  places.push_back(std::move(place));
  const bool is_program = command.parent() == nullptr;
  for (const Command* inner : command.commands()) {
    add_places(program, *inner, path_below(path, *inner),
               is_program ? std::vector<OptionText>() : own, places);
  }
}

std::vector<Place> places_of(const Command& program) {
  std::vector<Place> places;
  add_places(program, program, "", {}, places);
  return places;
}

// 'text' as one word of bash, zsh or fish, which differ in what a backslash means.
std::string quoted(std::string_view text, const char* quote) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') {
      out += quote;
    } else {
      out += c;
    }
  }
  return out + "'";
}
constexpr const char* kPosixQuote = "'\\''";
constexpr const char* kFishQuote = "\\'";

std::vector<std::string> command_names(const Place& place) {
  std::vector<std::string> names;
  for (const Command* inner : place.commands) names.push_back(inner->name());
  return names;
}

std::vector<std::string> names_with_values(const Place& place) {
  std::vector<std::string> names;
  for (const OptionText& option : place.options) {
    if (!option.metavar.empty()) {
      names.insert(names.end(), option.names.begin(), option.names.end());
    }
  }
  return names;
}

// The call of a helper of the scripts that offers values; empty if there is nothing to offer.
std::string offer(const OptionText& option) {
  if (!option.choices.empty()) return "__boxtree_words " + joined(option.choices);
  switch (option.facts.values) {
    case Values::kOther:
    case Values::kCommands:  // are among the commands of the place
      break;
    case Values::kFiles:
      return "__boxtree_files";
    case Values::kCookedFiles:
      return "__boxtree_files bxt";
    case Values::kCookedFilesAndMeshes:
      return "__boxtree_files bxt " + joined(mesh_endings());
    case Values::kMeshes:
      return "__boxtree_files " + joined(mesh_endings());
    case Values::kProfiles:
      return "__boxtree_files toml";
    case Values::kFolders:
      return "__boxtree_folders";
    case Values::kMeshEndings:
      return "__boxtree_words " + joined(mesh_endings());
  }
  return {};
}

// "query --tree" or "query 0", and what is offered there. `line` makes a line of the script of
// both; a positional that repeats stands for its number and all later ones.
template <class Line>
std::string value_table(const std::vector<Place>& places, const Line& line) {
  std::string table;
  for (const Place& place : places) {
    for (const OptionText& option : place.options) {
      const std::string offered = offer(option);
      if (offered.empty() || option.metavar.empty()) continue;
      for (const std::string& name : option.names) {
        table += line(place.path + " " + name, false, offered);
      }
    }
    std::size_t number = 0;
    for (const OptionText& positional : place.positionals) {
      const std::string offered = offer(positional);
      const std::string key = place.path + " " + std::to_string(number++);
      if (!offered.empty()) table += line(key, positional.repeats, offered);
    }
  }
  return table;
}

// The table of bash and zsh.
std::string posix_values(const std::vector<Place>& places) {
  return value_table(places, [](const std::string& key, bool repeats, const std::string& offered) {
    const std::string pattern =
        repeats ? quoted(key.substr(0, key.rfind(' ') + 1), kPosixQuote) + "[0-9]*"
                : quoted(key, kPosixQuote);
    return "    " + pattern + ") " + offered + " ;;\n";
  });
}

// What bash and zsh do alike: words before the cursor, of which `first` is the first argument, to
// command, option and given.
std::string posix_walk(const char* first, const char* current) {
  return fmt::format(R"sh(  __boxtree_place ''
  for ((i = {}; i < {}; i++)); do
    word=${{words[i]}}
    if [[ -n $option ]]; then
      [[ $word == = ]] || option=
    elif [[ $word == -?* ]]; then
      [[ " $takes " == *" $word "* ]] && option=$word
    elif [[ -n $word && " $commands " == *" $word "* ]]; then
      command=${{command:+$command }}$word given=0
      __boxtree_place "$command"
    else
      given=$((given + 1))
    fi
  done
)sh",
                     first, current);
}

std::string bash_script(const Command& program) {
  const std::vector<Place> places = places_of(program);
  std::string table;
  for (const Place& place : places) {
    std::vector<std::string> options;
    for (const OptionText& option : place.options) {
      options.insert(options.end(), option.names.begin(), option.names.end());
    }
    table += fmt::format("    {})\n      commands={} after={} takes={}\n      options={} ;;\n",
                         quoted(place.path, kPosixQuote),
                         quoted(joined(command_names(place)), kPosixQuote), place.commands_after,
                         quoted(joined(names_with_values(place)), kPosixQuote),
                         quoted(joined(options), kPosixQuote));
  }
  return R"sh(# bash completion for boxtree, made by: boxtree completion bash
# shellcheck shell=bash

# What there is after a command.
__boxtree_place() {
  case $1 in
)sh" + table +
         R"sh(  esac
}

__boxtree_words() {
  local found
  while IFS= read -r found; do COMPREPLY+=("$found"); done < <(compgen -W "$*" -- "$cur")
}
__boxtree_folders() {
  local found
  compopt -o filenames 2>/dev/null
  while IFS= read -r found; do COMPREPLY+=("$found"); done < <(compgen -d -- "$cur")
}
# Files with one of these endings, or any files; and folders, which may contain some.
__boxtree_files() {
  local ending found
  if (($# == 0)); then
    compopt -o filenames 2>/dev/null
    while IFS= read -r found; do COMPREPLY+=("$found"); done < <(compgen -f -- "$cur")
    return
  fi
  __boxtree_folders
  for ending; do
    while IFS= read -r found; do
      [[ -d $found ]] || COMPREPLY+=("$found")
    done < <(compgen -f -X "!*.$ending" -- "$cur"; compgen -f -X "!*.${ending^^}" -- "$cur")
  done
}

# The values of an option, or of a positional by its number.
__boxtree_value() {
  case $1 in
)sh" + posix_values(places) +
         R"sh(  esac
}

_boxtree() {
  local cur=${COMP_WORDS[COMP_CWORD]} command='' option='' given=0 word i
  local commands='' after=0 options='' takes=''
  local -a words=("${COMP_WORDS[@]}")
  COMPREPLY=()
)sh" + posix_walk("1", "COMP_CWORD") +
         R"sh(  if [[ -n $option ]]; then
    [[ $cur == = ]] && cur=''
    __boxtree_value "$command $option"
  elif [[ $cur == -* ]]; then
    __boxtree_words "$options"
  else
    ((given >= after)) && __boxtree_words "$commands"
    __boxtree_value "$command $given"
  fi
}

complete -F _boxtree boxtree
)sh";
}

// "name:description" for zsh, where a colon in a name or description is escaped.
std::string described(const std::string& name, const std::string& description) {
  std::string text;
  for (const char c : description) {
    if (c == ':' || c == '\\') text += '\\';
    text += c;
  }
  return quoted(name + ":" + text, kPosixQuote);
}

std::string zsh_script(const Command& program) {
  const std::vector<Place> places = places_of(program);
  std::string table;
  for (const Place& place : places) {
    table += fmt::format("    {})\n      commands={} after={} takes={}\n      described_commands=(",
                         quoted(place.path, kPosixQuote),
                         quoted(joined(command_names(place)), kPosixQuote), place.commands_after,
                         quoted(joined(names_with_values(place)), kPosixQuote));
    for (const Command* inner : place.commands) {
      table += "\n        " + described(inner->name(), inner->summary());
    }
    table += ")\n      options=(";
    for (const OptionText& option : place.options) {
      for (const std::string& name : option.names) {
        table += "\n        " + described(name, option.description);
      }
    }
    table += ") ;;\n";
  }
  return R"sh(#compdef boxtree
# zsh completion for boxtree, made by: boxtree completion zsh

# What there is after a command.
__boxtree_place() {
  case $1 in
)sh" + table +
         R"sh(  esac
}

__boxtree_words() { compadd -- "$@" }
__boxtree_folders() { _files -/ }
__boxtree_files() {
  if (( $# == 0 )); then _files; else _files -g "*.(#i)(${(j:|:)@})(-.)";
  fi
}

#The values of an option, or of a positional by its number.
__boxtree_value() {
  case $1 in
)sh" + posix_values(places) +
         R"sh(  esac
}

_boxtree() {
  emulate -L zsh
  setopt extended_glob
  local cur=${words[CURRENT]} command='' option='' given=0 word i commands='' after=0 takes=''
  local -a described_commands options
)sh" + posix_walk("2", "CURRENT") +
         R"sh(  if [[ -n $option ]]; then
    __boxtree_value "$command $option"
  elif [[ $cur == --*=* ]]; then
    option=${cur%%=*}
    compset -P 1 '*='
    __boxtree_value "$command $option"
  elif [[ $cur == -* ]]; then
    _describe -o option options
  else
    (( $#described_commands && given >= after )) && _describe command described_commands
    __boxtree_value "$command $given"
  fi
}

_boxtree "$@"
)sh";
}

std::string fish_script(const Command& program) {
  const std::vector<Place> places = places_of(program);
  std::string table, rules;
  for (const Place& place : places) {
    table += fmt::format("        case {}\n            set commands {}\n            set takes {}\n",
                         quoted(place.path, kFishQuote), joined(command_names(place)),
                         joined(names_with_values(place)));
    const std::string at = "__boxtree_is_at " + quoted(place.path, kFishQuote);
    const std::string here = "complete -c boxtree -n " + quoted(at, kFishQuote);
    for (const Command* inner : place.commands) {
      rules += fmt::format("complete -c boxtree -n {} -a {} -d {}\n",
                           quoted(fmt::format("{} {} more", at, place.commands_after), kFishQuote),
                           inner->name(), quoted(inner->summary(), kFishQuote));
    }
    for (const OptionText& option : place.options) {
      std::string names;
      for (const std::string& name : option.names) {
        names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      std::string values = option.metavar.empty() ? "" : " -x";
      if (!values.empty() && !offer(option).empty()) {
        values += " -a " + quoted("(" + offer(option) + ")", kFishQuote);
      }
      rules += here + names + values + " -d " + quoted(option.description, kFishQuote) + "\n";
    }
  }
  rules +=
      value_table(places, [](const std::string& key, bool repeats, const std::string& offered) {
        const std::size_t blank = key.rfind(' ');
        const std::string last = key.substr(blank + 1);
        if (last.front() == '-') return std::string();  // an option, which has its rule
        return fmt::format(
            "complete -c boxtree -n {} -a {}\n",
            quoted(fmt::format("__boxtree_is_at {} {}{}", quoted(key.substr(0, blank), kFishQuote),
                               last, repeats ? " more" : ""),
                   kFishQuote),
            quoted("(" + offered + ")", kFishQuote));
      });
  return R"sh(# fish completion for boxtree, made by: boxtree completion fish

# The command before the cursor, and how many positionals it was given, a line each.
function __boxtree_walk
    set -l command ''
    set -l given 0
    set -l option ''
    set -l commands
    set -l takes
    for word in '' (commandline -opc)[2..-1]
        if test -n "$option"
            set option ''
            continue
        else if string match -q -- '-?*' $word
            contains -- $word $takes; and set option $word
            continue
        else if contains -- "$word" $commands
            set command (string trim -- "$command $word")
            set given 0
        else if test -n "$word"
            set given (math $given + 1)
            continue
        end
        switch $command
)sh" + table +
         R"sh(        end
    end
    echo $command
    echo $given
end

# Whether that is the command and, if one is named, the number of the positional.
function __boxtree_is_at
    set -l at (__boxtree_walk)
    test "$at[1]" = "$argv[1]"; or return 1
    test (count $argv) -lt 2; and return 0
    test "$at[2]" -eq "$argv[2]"; and return 0
    test (count $argv) -eq 3 -a "$at[2]" -gt "$argv[2]"
end

function __boxtree_words
    string join \n -- $argv
end
function __boxtree_folders
    __fish_complete_directories (commandline -ct | string replace -r '^--[^=]*=' '')
end
function __boxtree_files
    set -l token (commandline -ct | string replace -r '^--[^=]*=' '')
    if test (count $argv) -eq 0
        __fish_complete_path $token
    else
        set -l endings (string join '|' -- $argv)
        __fish_complete_path $token | string match -ri -- "^.*(?:/|\.(?:$endings))(?:\t.*)?\$"
    end
end

complete -c boxtree -f
)sh" + rules;
}

}  // namespace

std::string completion_script(const Command& program, std::string_view shell) {
  if (shell == "bash") return bash_script(program);
  return shell == "zsh" ? zsh_script(program) : fish_script(program);
}

}  // namespace boxtree::cooker
