#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Makes the documentation of the public headers (build/api) and fails where Doxygen finds fault with
# a comment; before that, that it would find one.
# usage: tools/check_doxygen.sh
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."

planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
printf '/// See @ref nowhere.\nint planted();\n' >"$planted/planted.h"
if printf '@INCLUDE = docs/Doxyfile\nINPUT = %s\nOUTPUT_DIRECTORY = %s\n' "$planted" "$planted" |
  doxygen - 2>"$planted/said"; then
  echo "check_doxygen: a reference to nothing passes" >&2
  exit 1
fi
grep -q "nowhere" "$planted/said" || {
  cat "$planted/said" >&2
  exit 1
}

rm -rf build/api
doxygen docs/Doxyfile
echo "check_doxygen: no fault in the comments; build/api/index.html shows them"
