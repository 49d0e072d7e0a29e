#!/usr/bin/env bash
# Writes every kind of bag of the same frames: write.sh MODULES FOLDER|small OUT (see README.md).
set -euo pipefail
modules=$(readlink -f "$1")
frames=$2
out=$3
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"

/usr/bin/python3 "$here/frames.py" "$frames" "$work/frames"
for variant in none lz4 zstd flat big_endian; do
  node "$here/write_ros2.mjs" "$modules" "$work/frames" "$out/$variant.mcap" "$variant"
done
node "$here/write_ros2.mjs" "$modules" "$work/frames" "$work/messages" messages
/usr/bin/python3 "$here/write_sqlite.py" "$work/messages" "$out/small.db3"
/usr/bin/python3 "$here/write_sqlite.py" "$work/messages" "$out/split" split
/usr/bin/python3 "$here/write_sqlite.py" "$work/messages" "$out/packed" packed
for kind in none bz2 lz4 realsense; do
  /usr/bin/python3 "$here/write_ros1.py" "$work/frames" "$out/$kind.bag" "$kind"
done
