// SPDX-License-Identifier: MIT
// What does a ball that rests in the level touch, and how does it leave it?
//   collide level.bxt
#include <cstdio>
#include <vector>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: collide level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  const auto tree = file ? boxtree::Tree::bind(*file) : file.error();
  if (!tree) {
    std::fprintf(stderr, "%s\n", tree.error().message().c_str());
    return 1;
  }

  // The triangles that it touches, into memory of the program's own.
  const boxtree::Sphere ball{{2.5, 0, 0.75}, 0.375};
  std::vector<boxtree::Contact> contacts;
  const auto visit = boxtree::collide(*tree, ball, [&](const boxtree::Contact& contact) {
    contacts.push_back(contact);
    return true;
  });
  if (!visit) return 1;
  std::printf("%zu triangles", contacts.size());
  contacts.resize(boxtree::merge_contacts(contacts, 1e-6));
  std::printf(", of one point %zu\n", contacts.size());
  boxtree::Contact deepest;
  for (const auto& contact : contacts) {
    if (contact.depth >= deepest.depth) deepest = contact;
  }
  std::printf("out by %.3f along (%.1f, %.1f, %.1f)\n", deepest.depth, deepest.normal[0],
              deepest.normal[1], deepest.normal[2]);

  // Whether a capsule stands free: the visitor stops at the first face.
  const boxtree::Capsule body{{2.5, 0, 0.8}, {2.5, 0, 2}, 0.25};
  const auto met =
      boxtree::overlap_capsule(*tree, body, [](const boxtree::FaceRef&) { return false; });
  if (!met) return 1;
  std::printf("the body %s\n", *met == boxtree::Visit::kStopped ? "touches" : "stands free");
  return 0;
}
