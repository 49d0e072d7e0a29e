#!/usr/bin/env bash
# check.sh VANTAGE SECOND_EVALUATOR: reconstructs a mug in a few scans, has its map evaluated by the program and by the
# second evaluator, and compares.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for views in 1 4; do
  "$1" reconstruct mug --max-views "$views" --no-report --quiet --out "$folder/$views" >/dev/null
  for rays in 79 40; do
    "$1" evaluate "$folder/$views/map.nrrd" --candidates sphere:80:2 --camera "45x45:${rays}x${rays}" --current 0.3,0.4,1.9 --json >"$folder/evaluation.json"
    "$2" "$folder/$views/map.nrrd" "$folder/evaluation.json" 80 2 45 45 "$rays" "$rays" 0.3 0.4 1.9
  done
done
