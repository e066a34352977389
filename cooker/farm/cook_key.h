// SPDX-License-Identifier: MIT
// The key of a job: a digest of everything that can change a byte of its output, and of nothing
// else. Equal keys mean equal outputs, on any machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <boxtree/error.h>

#include "cooker/farm/job_files.h"
#include "cooker/farm/sha256.h"
#include "cooker/shell/cook_job.h"

namespace boxtree::cooker {

struct KeyedFile {
  JobFile file;
  Digest digest;
};

struct JobKey {
  Digest key;
  std::vector<KeyedFile> files;  // all that the cook reads, as list_job_files
};

/// The key of a job: SHA-256 over the version of the format, cooker_identity(), import_libraries()
/// if assimp reads one of the meshes, the options in one canonical form, and the digests of all
/// files that the cook reads, each with its name where names go into the output (trees are called
/// after their files). Folders, the output, threads and the time of files are not in it.
///
/// Precondition: job.options is what a command line makes of its options: `costs`, `known_edges`,
/// `keep_all` and `face_order` have their defaults. Reads every file once. Errors: those of
/// list_job_files and `digest_of`, by which files are digested. `list_files`: as for
/// list_job_files.
using DigestOf = std::function<Result<Digest>(const std::filesystem::path& file)>;
Result<JobKey> key_of(const CookJob& job, const DigestOf& digest_of = sha256_of_file,
                      const ListFiles& list_files = list_source_files);

/// The text that the key is the digest of, for people who look for the difference of two keys.
[[nodiscard]] std::string key_text(const CookJob& job, const std::vector<KeyedFile>& files);

}  // namespace boxtree::cooker
