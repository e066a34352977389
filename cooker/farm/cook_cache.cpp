// SPDX-License-Identifier: MIT
#include "cooker/farm/cook_cache.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "cooker/farm/folder_cache.h"
#include "cooker/farm/http_cache.h"
#include "cooker/system/path.h"

namespace boxtree::cooker {
namespace {

template <class Cache>
Result<std::unique_ptr<CookCache>> allocated(Result<Cache> cache) {
  if (!cache) return cache.error();
  return std::unique_ptr<CookCache>(std::make_unique<Cache>(std::move(*cache)));
}

}  // namespace

Result<CookCache::Entry> CookCache::store(const Digest& key, const std::filesystem::path& output,
                                          const std::string& report) const {
  Result<Entry> entry = keep(key, output, report);
  if (!entry) note(entry.error());
  return entry;
}

std::vector<std::string> CookCache::take_warnings() const {
  const std::lock_guard lock(warnings_->mutex);
  return std::exchange(warnings_->texts, {});
}

void CookCache::note(const Error& fault) const {
  {
    const std::lock_guard lock(warnings_->mutex);
    if (std::exchange(warnings_->has_fault, true)) return;
  }
  warn(fault.detail);
}

void CookCache::warn(std::string warning) const {
  const std::lock_guard lock(warnings_->mutex);
  warnings_->texts.push_back(std::move(warning));
}

bool has_output(const std::filesystem::path& file, const CookCache::Entry& entry) {
  std::error_code error;
  if (std::filesystem::file_size(file, error) != entry.bytes || error) return false;
  const Result<Digest> digest = sha256_of_file(file);
  return digest && *digest == entry.output;
}

bool is_url(const std::string& place) {
  const std::size_t end = place.find("://");
  return end != std::string::npos && end > 0 &&
         std::all_of(place.begin(), place.begin() + static_cast<std::ptrdiff_t>(end),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); });
}

Result<std::unique_ptr<CookCache>> open_cache(const std::string& place, std::uint64_t most_bytes) {
  if (is_url(place)) return allocated(HttpCache::open(place));
  return allocated(FolderCache::open(named_path(place), most_bytes));
}

}  // namespace boxtree::cooker
