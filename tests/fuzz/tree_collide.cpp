// SPDX-License-Identifier: MIT
// What spheres, capsules, boxes and hulls touch in the tree of any file: contacts, and faces.
#include <vector>

#include "tests/fuzz/answers.h"
#include "tests/fuzz/shape_input.h"
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {
namespace {

constexpr std::size_t kKept = 32;  // contacts that are merged

template <class Shape>
void touch(const Tree& tree, const Shape& shape, const QueryInput& query, const Check& check) {
  const std::uint32_t most = query.option(3) == 0 ? ~0u : query.option(3);
  std::vector<Contact> contacts;
  std::uint32_t touches = 0;
  const auto collided = collide(
      tree, shape,
      [&](const Contact& contact) {
        check_contact(contact, query, check);
        if (contacts.size() < kKept) contacts.push_back(contact);
        return ++touches < most;
      },
      query.limits());
  check(collided);
  std::uint32_t faces = 0;
  const auto count = [&](const FaceRef&) { return ++faces < most; };
  const auto overlapped = overlap(tree, shape, count, query.limits());
  check(overlapped);
  // The same predicates decide, but for spheres.
  if (collided.ok() && overlapped.ok() && !std::is_same_v<Shape, Sphere> &&
      (touches > 0) != (faces > 0)) {
    finding("collide and overlap differ");
  }
  if (!contacts.empty()) {
    const FaceRef face = contacts.back().face;
    read_face(tree, face, contacts.back().triangle, check);
    const std::size_t merged = merge_contacts(contacts, query.number(6), query.number(7));
    if (merged == 0 || merged > contacts.size()) finding("no contact is kept, or more than all");
  }
}

}  // namespace

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    with_shape(query, [&](const auto& shape) { touch(tree, shape, query, check); });
  });
}

}  // namespace boxtree::fuzz
