// SPDX-License-Identifier: MIT
// In place of the folder cache and the journal, which other processes are kept from by locks of
// POSIX. Compiled elsewhere, this is nothing.
#ifdef _WIN32
#include "cooker/farm/folder_cache.h"
#include "cooker/farm/journal.h"

namespace boxtree::cooker {
namespace {

Error unsupported(const char* what) {
  return {Errc::kFeatureUnsupported,
          std::string(what) + " are not there on Windows; cook on Linux, or each mesh by a cook"};
}

}  // namespace

Result<FolderCache> FolderCache::open(const std::filesystem::path& /*folder*/,
                                      std::uint64_t /*most_bytes*/) {
  return unsupported("caches");
}

Result<std::optional<CookCache::Entry>> FolderCache::find(
    const Digest& /*key*/, const std::filesystem::path& /*output*/) const {
  return unsupported("caches");
}

Result<CookCache::Entry> FolderCache::keep(const Digest& /*key*/,
                                           const std::filesystem::path& /*output*/,
                                           const std::string& /*report*/) const {
  return unsupported("caches");
}

Result<Journal> Journal::open(const std::filesystem::path& /*path*/) {
  return unsupported("manifests");
}

Journal::Journal(Journal&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(other.descriptor_) {}
Journal::~Journal() = default;

Result<Digest> Journal::digest_of(const std::filesystem::path& file, bool* /*is_remembered*/) {
  return sha256_of_file(file);
}

Result<std::vector<std::filesystem::path>> Journal::files_of(const std::filesystem::path& /*mesh*/,
                                                             const FindFiles& /*find*/,
                                                             bool* /*is_remembered*/) {
  return unsupported("manifests");
}

std::optional<Journal::Entry> Journal::find(const std::filesystem::path& /*output*/,
                                            const Digest& /*key*/, bool /*may_remember*/) {
  return std::nullopt;
}

Status Journal::add(const std::filesystem::path& /*output*/, const Entry& /*entry*/) {
  return unsupported("manifests");
}

}  // namespace boxtree::cooker
#endif
