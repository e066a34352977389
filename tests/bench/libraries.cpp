// SPDX-License-Identifier: MIT
// Lists the libraries that are compiled into this program, and those that are not.
#include "tests/bench/libraries.h"

namespace boxtree::bench {

std::vector<Library> all_libraries(cooker::Builder builder) {
  std::vector<Library> libraries;
  add_original(libraries);
  add_boxtree(libraries, builder);
#ifdef BOXTREE_BENCH_EMBREE
  add_embree(libraries);
#endif
#ifdef BOXTREE_BENCH_BULLET
  add_bullet(libraries);
#endif
#ifdef BOXTREE_BENCH_FCL
  add_fcl(libraries);
#endif
#ifdef BOXTREE_BENCH_ODE
  add_ode(libraries);
#endif
#ifdef BOXTREE_BENCH_CGAL
  add_cgal(libraries);
#endif
  return libraries;
}

std::vector<std::string> missing_libraries() {
  std::vector<std::string> missing;
#ifndef BOXTREE_BENCH_EMBREE
  missing.emplace_back("embree");
#endif
#ifndef BOXTREE_BENCH_BULLET
  missing.emplace_back("bullet");
#endif
#ifndef BOXTREE_BENCH_FCL
  missing.emplace_back("fcl");
#endif
#ifndef BOXTREE_BENCH_ODE
  missing.emplace_back("ode");
#endif
#ifndef BOXTREE_BENCH_CGAL
  missing.emplace_back("cgal");
#endif
  return missing;
}

}  // namespace boxtree::bench
