// SPDX-License-Identifier: MIT
// `boxtree verify` of any file: the proof of each tree and of the scene.
#include "cooker/proof/proof.h"
#include "tests/fuzz/query_input.h"
#include "tests/fuzz/target.h"

namespace boxtree::fuzz {

void run(Bytes bytes) {
  const Input input(bytes);
  const Result<File> file = File::open(input.file());
  if (!file) return;
  const cooker::Findings findings = cooker::verify_file(*file);
  for (const Error& error : findings) {
    if (error.code == Errc::kInternal || error.detail.empty()) finding("a finding without words");
  }
  if (!findings.empty()) return;
  // What verify accepts, binds.
  for (std::uint32_t i = 0; i < file->tree_count(); ++i) {
    const Errc code = Tree::bind(*file, i).code();
    if (code != Errc::kOk && code != Errc::kExternalMeshNeeded) finding("verify accepts, bind not");
  }
  if (file->has_scene() && !Scene::bind(*file)) finding("verify accepts, Scene::bind does not");
}

}  // namespace boxtree::fuzz
