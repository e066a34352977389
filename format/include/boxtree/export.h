// SPDX-License-Identifier: MIT
// What a shared library of the runtime exports: BOXTREE_API marks it. Stands for nothing elsewhere,
// in archives and in programs. Other public headers include it before they declare anything, so it
// is the one that refuses older C++.
#pragma once

#if __cplusplus < 201709L && (!defined(_MSVC_LANG) || _MSVC_LANG < 202002L)  // what g++ 10 says of C++20
#error "boxtree needs C++20: compile with -std=c++20, or link boxtree::runtime in CMake"
#endif

#if defined(BOXTREE_BUILDS_SHARED) && defined(_MSC_VER)  // not tested
#define BOXTREE_API __declspec(dllexport)
#elif defined(BOXTREE_BUILDS_SHARED)
#define BOXTREE_API __attribute__((visibility("default")))
#else
#define BOXTREE_API
#endif
