// SPDX-License-Identifier: MIT
// A child process, its standard output read to the end.
#include "cooker/cli/peers.h"

#include <array>
#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>
#ifndef _WIN32
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

#include "cooker/system/input_failure.h"
#include "cooker/system/posix.h"
#include "cooker/text/json.h"

namespace boxtree::cooker {
namespace {

#ifdef _WIN32
Result<std::string> output_of(const std::vector<std::string>& command, bool /*quiet*/) {
  return Error{Errc::kFeatureUnsupported,
               command[0] + ": peers are not measured on Windows; measure them on Linux"};
}
#else
// What a program prints on standard output.
Result<std::string> output_of(const std::vector<std::string>& command, bool quiet) {
  std::array<int, 2> ends{};
  if (!open_pipe(ends)) {
    return Error{Errc::kInternal, "pipe: " + std::generic_category().message(errno)};
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  if (quiet) {
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  }
  std::vector<char*> arguments;
  for (const std::string& argument : command)
    arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int failed =
      ::posix_spawn(&child, arguments[0], &actions, nullptr, arguments.data(), environment());
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (failed != 0) {
    ::close(ends[0]);
    return input_failure(command[0], failed);
  }
  std::string text;
  std::array<char, 65536> block;
  ssize_t got = 0;
  while ((got = ::read(ends[0], block.data(), block.size())) > 0 || (got < 0 && errno == EINTR)) {
    if (got > 0) text.append(block.data(), static_cast<std::size_t>(got));
  }
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    return Error{Errc::kFileUnreadable,
                 command[0] + ": ended with status " + std::to_string(status)};
  }
  return text;
}
#endif

std::optional<PeerRow> row_of(const Json& json) {
  PeerRow row;
  const std::array texts{std::pair("mesh", &PeerRow::mesh), std::pair("library", &PeerRow::library),
                         std::pair("variant", &PeerRow::variant),
                         std::pair("metric", &PeerRow::metric), std::pair("unit", &PeerRow::unit)};
  for (const auto& [key, text] : texts) {
    const Json* const found = json.find(key);
    if (found == nullptr || !found->is_string()) return std::nullopt;
    row.*text = found->get<std::string>();
  }
  const Json* const value = json.find("value");
  if (value == nullptr || !value->is_number()) return std::nullopt;
  row.value = value->get<double>();
  return row;
}

}  // namespace

Result<std::vector<PeerRow>> run_peers(const std::filesystem::path& program,
                                       const std::vector<std::string>& arguments, bool quiet) {
  std::vector<std::string> command = {program.string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  command.emplace_back("--json");
  const Result<std::string> text = output_of(command, quiet);
  if (!text) return text.error();
  const ParsedJson document = parse_json(*text);
  const Json* const list = document.value.find("rows");
  if (list == nullptr || !list->is_array()) {
    return Error{Errc::kDocumentInvalid,
                 program.string() + ": printed no JSON with an array \"rows\""};
  }
  std::vector<PeerRow> rows;
  for (const Json& json : *list) {
    std::optional<PeerRow> row = row_of(json);
    if (!row) {
      return Error{Errc::kDocumentInvalid,
                   program.string() + ": rows[" + std::to_string(rows.size()) +
                       "] is no row as boxtree_peers prints it: " + json.dump()};
    }
    rows.push_back(*std::move(row));
  }
  return rows;
}

}  // namespace boxtree::cooker
