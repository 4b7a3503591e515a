#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Builds the documentation of the public headers (build/api); fails if Doxygen warns about a comment.
# First checks that it does warn about a wrong reference.
# usage: tools/check_doxygen.sh
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."

planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
printf '/// See @ref nowhere.\nint planted();\n' >"$planted/planted.h"
if printf '@INCLUDE = docs/Doxyfile\nINPUT = %s\nOUTPUT_DIRECTORY = %s\n' "$planted" "$planted" |
  doxygen - 2>"$planted/output"; then
  echo "check_doxygen: Doxygen accepts a wrong reference" >&2
  exit 1
fi
grep -q "nowhere" "$planted/output" || {
  cat "$planted/output" >&2
  exit 1
}

rm -rf build/api
doxygen docs/Doxyfile
echo "check_doxygen: no warnings (open build/api/index.html)"
