#!/bin/bash
# The commands under valgrind (memcheck): no access that is wrong, nothing that is not initialised decides, nothing is lost for good.
# usage: valgrind.sh PROGRAM      (Debian's valgrind; some five minutes of one core; 77: not here)
set -euo pipefail
command -v valgrind > /dev/null || { echo "skipped: no valgrind"; exit 77; }
program=$(realpath "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
failed=0

# check NAME EXIT_CODE ARGUMENT...
check() {
  local name=$1 expected=$2 code=0
  shift 2
  valgrind -q --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite --error-exitcode=99 \
    "$program" "$@" > "$name.log" 2>&1 || code=$?
  if ((code == expected)); then
    echo "ok    $name (${SECONDS} s)"
  else
    echo "FAIL  $name: exit code $code, expected $expected"
    grep -aE '^==|^edgeslam' "$name.log" | head -40
    failed=1
  fi
}

"$program" simulate panels --frames 90 --width 320 --height 240 --output scene > /dev/null 2>&1
check simulate 0 simulate panels --frames 3 --width 160 --height 120 --output another
check replay 0 replay scene --output result --map-out robot.map --drawings 2
check go_on 0 replay scene --output gone_on --map-in robot.map --drawings 0
check realtime 0 replay scene --output live --realtime --pace 0.1 --record recording --drawings 0
check repeat 0 replay recording --output repeated --drawings 0
check run 0 run --source scene
check evaluate 0 evaluate result/trajectory.txt scene/groundtruth.txt
check report 0 report result gone_on --output both.html
check check_config 0 check-config --print-default
check cameras 0 cameras
head -c 1000 robot.map > torn.map
check torn_map 2 replay scene --output none --map-in torn.map
printf 'edges: {sigam: 1}\n' > wrong.yaml
check wrong_key 2 check-config wrong.yaml
exit $failed
