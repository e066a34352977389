// SPDX-License-Identifier: MIT
// All commands of the program.
#pragma once

namespace boxtree::cooker {

class Command;

/// Each adds a command to `program` and stores its exit status in `status` when it has run.
void add_cook_command(Command& program, int& status);
void add_key_command(Command& program, int& status);
void add_info_command(Command& program, int& status);
void add_verify_command(Command& program, int& status);
void add_query_command(Command& program, int& status);
void add_bench_command(Command& program, int& status);
void add_report_command(Command& program, int& status);
void add_export_command(Command& program, int& status);
void add_pack_command(Command& program, int& status);
void add_split_command(Command& program, int& status);
void add_tile_command(Command& program, int& status);
void add_merge_command(Command& program, int& status);
void add_completion_command(Command& program, int& status);
void add_help_command(Command& program, int& status);

}  // namespace boxtree::cooker
