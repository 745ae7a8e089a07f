#!/bin/bash
# The stages up to the flow give the same bits on ARM, where NEON kernels run, as here.   usage: same_bits.sh FOLDER STAGE_HASHES
set -euo pipefail
folder=$1
hashes=$2
scripts=$(dirname "${BASH_SOURCE[0]}")

"$hashes" > "$folder/hashes_here.txt" 2> "$folder/kernels_here.txt"
code=0
"$scripts/emulate.sh" "$folder" stage_hashes > "$folder/hashes_arm.txt" 2> "$folder/kernels_arm.txt" || code=$?
if ((code != 0)); then cat "$folder/hashes_arm.txt" "$folder/kernels_arm.txt"; exit $code; fi
cat "$folder/kernels_here.txt" "$folder/kernels_arm.txt"
grep -qw NEON "$folder/kernels_arm.txt" || { echo "FAILED: no NEON kernels on ARM"; exit 1; }

# What the C library computes (sine, arctangent) is within a rounding of the same.
if ! diff <(grep -v '^libm' "$folder/hashes_here.txt") <(grep -v '^libm' "$folder/hashes_arm.txt"); then
  echo "FAILED: these stages give other bits on ARM"
  exit 1
fi
echo "ok: $(grep -cv '^libm' "$folder/hashes_here.txt") hashes are the same"
