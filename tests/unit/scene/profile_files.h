// SPDX-License-Identifier: MIT
// A folder for one test, with a profile in it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <tests/support/temp_folder.h>

#include <gtest/gtest.h>

#include "cooker/scene/profile.h"

namespace boxtree::cooker {

class ProfileTest : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, std::string_view text) const {
    return temp_.write(name, text);
  }
  // A profile that must be right.
  Profile load(std::string_view text) const {
    Result<Profile> profile = read_profile(write("scene.toml", text));
    EXPECT_TRUE(profile.ok()) << profile.error().message();
    return profile.ok() ? std::move(profile).value() : Profile();
  }
  // What is wrong with a profile, from its name on: "scene.toml:3: ...".
  std::string fault(std::string_view text) const {
    const Result<Profile> profile = read_profile(write("scene.toml", text));
    EXPECT_FALSE(profile.ok()) << text;
    if (profile.ok()) return {};
    EXPECT_EQ(profile.code(), Errc::kProfileInvalid);
    return without_folder(profile.error().detail);
  }
  std::string without_folder(const std::string& text) const {
    const std::string folder = (folder_ / "").string();
    EXPECT_EQ(text.rfind(folder, 0), 0u) << "starts with the path: " << text;
    return text.substr(folder.size());
  }

  test::TempFolder temp_;
  const std::filesystem::path& folder_ = temp_.path();
};

/// A text that is wrong, and what is said of it.
struct ProfileFault {
  const char* text;
  const char* message;
};

}  // namespace boxtree::cooker
