# SPDX-License-Identifier: MIT
# Read by the scripts of this folder, which have a folder $work and a function fail.
# shellcheck shell=bash disable=SC2154
# quiet COMMAND...: runs it; its output is shown if it fails.
quiet() { "$@" >"$work/log" 2>&1 || { tail -40 "$work/log"; fail "$* failed"; }; }
