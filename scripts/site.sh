#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the site of all pages in build/site, with search, the C++ reference (Doxygen) and the Python
# reference, and checks every link of it. The site works from the folder: open build/site/index.html.
# Debian packages: python3-sphinx, furo, python3-myst-parser, python3-sphinxcontrib.bibtex, doxygen.
# Usage: scripts/site.sh [FOLDER]   (instead of build/site; $KELPIE_BUILD_DIR, else build/release,
# has the Python module)
set -euo pipefail
cd "$(dirname "$0")/.."

site=$(realpath -m "${1:-build/site}")
build=$(realpath -m "${KELPIE_BUILD_DIR:-build/release}")
fail() { echo "site.sh: $1" >&2; exit 1; }
for package in sphinx furo myst_parser sphinxcontrib.bibtex; do
  /usr/bin/python3 -c "import $package" 2>/dev/null ||
    fail "install the Debian packages python3-sphinx furo python3-myst-parser python3-sphinxcontrib.bibtex"
done
PYTHONPATH=$build/python /usr/bin/python3 -c "import kelpie" 2>/dev/null ||
  fail "$build/python has no module kelpie; build it, or name the folder by KELPIE_BUILD_DIR"

stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
extra=$stage/extra
mkdir -p "$extra/api"
scripts/docs.sh "$stage/doxygen" >/dev/null
mv "$stage/doxygen/html" "$extra/api/cpp"
PYTHONPATH=$build/python /usr/bin/python3 -m kelpie.benchmark page scripts/site/benchmark.json \
  --out "$extra/benchmark_results.html"

# The pages keep their places, so that their links hold; the README is the start page.
pages=$stage/pages
mkdir -p "$pages"
git ls-files -z -- '*.md' docs include examples src lab scenarios vehicles scripts python/kelpie/benchmark CITATION.cff LICENSE |
  xargs -0 cp --parents -t "$pages"
cat "$pages/README.md" scripts/site/contents.md >"$pages/index.md"
rm -r "$pages/README.md" "$pages/scripts/site"
cp scripts/site/*_api.md scripts/site/bibliography.md scripts/site/benchmark.md "$pages"
sed -i 's#\(](\(\.\./\)*\)README\.md#\1index.md#; s#](\([./a-z]*\)docs/bibliography\.bib)#](\1bibliography.md)#g' \
  "$pages"/*.md
find "$pages/docs" "$pages/src" -name '*.md' -exec sed -i \
  's#](\(\.\./\)bibliography\.bib)#](../../bibliography.md)#g' {} +

rm -rf "$site"
KELPIE_SITE_EXTRA=$extra PYTHONPATH=$build/python \
  /usr/bin/python3 -m sphinx -q -W --keep-going -b html -c scripts/site "$pages" "$site"
rm -rf "$site/.doctrees" "$site/.buildinfo" "$site/objects.inv"
/usr/bin/python3 scripts/site/check.py "$site"
echo "Site: $site/index.html"
