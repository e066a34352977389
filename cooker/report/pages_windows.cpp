// SPDX-License-Identifier: MIT
// In place of pages.cpp, whose signals Windows does not have.
#ifdef _WIN32
#include "cooker/report/pages.h"

namespace boxtree::cooker {
namespace {

Error no_pages() {
  return {
      Errc::kFeatureUnsupported,
      "pages that queries read are not counted on Windows; count them on Linux, where there are "
      "as many"};
}

}  // namespace

Result<PageFigures> measure_pages(const std::filesystem::path& /*path*/, std::uint32_t /*tree*/,
                                  std::size_t /*queries*/) {
  return no_pages();
}

Result<std::vector<FirstRays>> measure_first_rays(const std::filesystem::path& /*path*/,
                                                  std::uint32_t /*tree*/, std::size_t /*rays*/) {
  return no_pages();
}

Result<std::vector<std::size_t>> pages_read(const std::filesystem::path& /*path*/,
                                            const std::function<Status(Bytes file)>& /*read*/) {
  return no_pages();
}

}  // namespace boxtree::cooker
#endif
