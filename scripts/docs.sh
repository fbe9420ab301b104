#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the API reference (Doxygen) in build/docs/html. A warning is an error. Fields, functions
# without parameters, defaulted functions, and copy and move functions may lack documentation.
# Usage: scripts/docs.sh [FOLDER]   (instead of build/docs)
set -euo pipefail
cd "$(dirname "$0")/.."

command -v doxygen >/dev/null || { echo "install the Debian package doxygen" >&2; exit 1; }
folder=${1:-build/docs}
mkdir -p "$folder"
{ cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = \"$folder\""; } |
  doxygen - 2>"$folder/warnings" || { cat "$folder/warnings" >&2; exit 1; }
if grep -vE '\((variable|function)\) of .* is not documented' "$folder/warnings" >&2 ||
   grep -E '\(function\) of .* is not documented' "$folder/warnings" |
     grep -vE '\(\) (const|override|=)|=default|operator=\(|Member ([A-Za-z]+)\((const )?\2 &' >&2; then
  exit 1
fi
echo "API reference: $folder/html/index.html"
