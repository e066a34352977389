// SPDX-License-Identifier: MIT
// Any text as a profile.
#include <string>
#include <string_view>

#include "cooker/scene/profile.h"
#include "tests/fuzz/target.h"
#include "tests/support/temp_folder.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  static const test::TempFolder folder;
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  const auto path = folder.write("scene.toml", text);
  const Result<cooker::Profile> profile = cooker::read_profile(path);
  if (profile) {
    if (profile->objects.empty()) finding("a profile without the object \"other\"");
    return;
  }
  if (profile.code() == Errc::kInternal) finding("a profile ends with kInternal");
  if (profile.error().detail.find("scene.toml") == std::string::npos &&
      profile.code() == Errc::kProfileInvalid) {
    finding("an error that does not name its file");
  }
}

}  // namespace boxtree::fuzz
