#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Checks that every source has the SPDX header, no file names a folder of one machine, and no file is
# too large.
set -euo pipefail

readonly kLargestBytes=3000000
readonly kLargestNetworkBytes=10000000
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mapfile -d '' -t files < <(git ls-files -z --cached --others --exclude-standard)
faults=0
fault() {
  echo "$*" >&2
  faults=$((faults + 1))
}

# Folders that exist only on some machines. A line that needs one has the words "machine path".
readonly kMachinePath='(^|[^A-Za-z0-9_.~})-])/(work|home|root|Users|mnt)/'

for file in "${files[@]}"; do
  [[ -f $file ]] || continue
  size=$(stat -c %s -- "$file")
  largest=$kLargestBytes
  [[ $file != networks/* ]] || largest=$kLargestNetworkBytes
  ((size <= largest)) || fault "$file: $size bytes, more than $largest"
  case $file in
    *.h | *.cpp | *.cu | *.cuh | *.py | *.sh | *.cmake | *CMakeLists.txt | .ci/run | *.toml | *.js)
      if [[ -s $file ]]; then
        opening=$(head -n 4 -- "$file")
        [[ $opening == *"SPDX-FileCopyrightText: "* &&
          $opening == *"SPDX-License-Identifier: Apache-2.0"* ]] ||
          fault "$file: no SPDX header in the first lines"
      fi
      ;;
  esac
  while IFS= read -r hit; do
    fault "$file:$hit: names a folder of one machine"
  done < <(grep -InE "$kMachinePath" -- "$file" | grep -v 'machine path' | cut -c 1-120)
done

if ((faults)); then
  echo "check_names: $faults errors"
  exit 1
fi
echo "check_names: ${#files[@]} files, no errors"
