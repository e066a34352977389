// SPDX-License-Identifier: MIT
// What a shared library of the runtime exports: BOXTREE_API marks it. Stands for nothing elsewhere,
// in archives and in programs.
#pragma once

#ifdef BOXTREE_BUILDS_SHARED
#define BOXTREE_API __attribute__((visibility("default")))
#else
#define BOXTREE_API
#endif
