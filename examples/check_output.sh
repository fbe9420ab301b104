#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs an example and compares what it prints with what the comment on its top states: those lines
# have to be there in that order, numbers to within a twentieth (or 0.01), for another processor
# rounds differently.
# Usage: check_output.sh SOURCE COMMAND...
set -euo pipefail

source=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sed -n '/^\(\/\/\|#\) Prints/,/^\(\/\/\|#\)\{0,1\}$/s/^\(\/\/\|#\)   //p' "$source" >"$work/stated"
[ -s "$work/stated" ] || { echo "$source doesn't state what it prints" >&2; exit 1; }
(cd "$work" && "$@") >"$work/printed"
cat "$work/printed"

LC_ALL=C awk '
  function number(word) { return word ~ /^[-+]?[0-9]+([.][0-9]+)?$/ }
  function near(a, b) { return (a - b) ^ 2 <= (b / 20) ^ 2 || (a - b) ^ 2 <= 0.01 ^ 2 }
  function alike(printed, stated,    a, b, n, i) {
    gsub(/[,:;]/, " ", printed); gsub(/[,:;]/, " ", stated)
    n = split(stated, b)
    if (split(printed, a) != n) return 0
    for (i = 1; i <= n; ++i)
      if (!(number(a[i]) && number(b[i]) ? near(a[i], b[i]) : a[i] == b[i])) return 0
    return 1
  }
  NR == FNR { stated[++lines] = $0; next }
  found < lines && alike($0, stated[found + 1]) { ++found }
  END {
    if (found < lines) {
      print "FAILED: nowhere, or not in its place: " stated[found + 1]
      exit 1
    }
  }' "$work/stated" "$work/printed"
