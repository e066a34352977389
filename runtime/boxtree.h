// SPDX-License-Identifier: MIT
// Everything an application needs: open a file, bind a tree, ask.
#pragma once

#include <boxtree/queries.h>
#include <boxtree/runtime/file/file.h>
#include <boxtree/runtime/tree/tree.h>
