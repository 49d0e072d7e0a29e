#!/usr/bin/env bash
# check.sh EXAMPLE CHECKER FOLDER_OF_EXAMPLES: lets the arm plan its views and checks every place of its moves against
# the true scene.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" "$3/arm.yaml" "$folder"
for order in by_travel by_utility; do
  "$2" "$3/arm.urdf" camera_optical "$folder/scene.off" "$folder/$order.txt" 20
done
