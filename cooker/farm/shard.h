// SPDX-License-Identifier: MIT
// Which of several processes takes a job.
#pragma once

#include <cstdint>

#include "cooker/farm/sha256.h"

namespace boxtree::cooker {

/// One of `count` shards, which are numbered from 0 as those of Slurm, Kubernetes and AWS Batch
/// are.
struct Shard {
  std::uint32_t number = 0;
  std::uint32_t count = 1;
};

/// The number of the shard of a job by the SHA-256 of its output's name, as the manifest has it:
/// its first 8 bytes as a big-endian number, modulo the count. So each job is in one shard,
/// whatever other jobs there are and whatever its inputs become, and a shard reads nothing to know
/// its jobs.
[[nodiscard]] std::uint32_t shard_of(const Digest& digest, std::uint32_t count);

}  // namespace boxtree::cooker
