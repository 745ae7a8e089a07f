#!/bin/bash
# The same recording replayed here and on ARM gives the same run.   usage: same_replay.sh FOLDER EDGESLAM
set -euo pipefail
folder=$1
edgeslam=$2
scripts=$(dirname "${BASH_SOURCE[0]}")

"$edgeslam" simulate panels_textured --frames 90 --width 320 --height 240 --force --output "$folder/recording" > /dev/null 2>&1
"$edgeslam" replay "$folder/recording" --output "$folder/result_here" > "$folder/replay_here.log" 2>&1
code=0
"$scripts/emulate.sh" "$folder" edgeslam replay "$folder/recording" --output "$folder/result_arm" > "$folder/replay_arm.log" 2>&1 || code=$?
if ((code != 0)); then cat "$folder/replay_arm.log"; exit $code; fi
# To the last digit: nothing on the way depends on the processor, but Ceres, which only closed loops need.
python3 "$scripts/compare_runs.py" "$folder/result_here" "$folder/result_arm"
for file in trajectory.txt trajectory_live.txt keyframes.txt map.ply; do
  cmp "$folder/result_here/$file" "$folder/result_arm/$file"
done
echo "ok: the same bytes in trajectories, keyframes and map"
