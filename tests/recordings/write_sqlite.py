"""Writes messages (write_ros2.mjs, variant messages) as SQLite files of ROS 2: write_sqlite.py MESSAGES OUT [KIND].

KIND `split` makes a folder with two files and metadata.yaml, `packed` one with each message compressed by zstd and the file
compressed again; without KIND, OUT is one file.
"""

import json
import pathlib
import sqlite3
import subprocess
import sys

TABLES = """
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL,
  offered_qos_profiles TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
"""


def zstd(data):
    return subprocess.run(["zstd", "-q", "-c"], input=data, stdout=subprocess.PIPE, check=True).stdout


def write(path, messages, pack=lambda data: data):
    path.unlink(missing_ok=True)
    database = sqlite3.connect(path)
    database.executescript(TABLES)
    database.execute("INSERT INTO schema VALUES (3, 'humble')")
    topics = {}
    for topic, kind, time, data in messages:
        if topic not in topics:
            topics[topic] = len(topics) + 1
            database.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')", (topics[topic], topic, kind))
        database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)",
                         (topics[topic], int(time), pack(data)))
    database.commit()
    database.execute("VACUUM")
    database.close()


def main():
    source, out = sys.argv[1], pathlib.Path(sys.argv[2])
    kind = sys.argv[3] if len(sys.argv) > 3 else ""
    blob, place, messages = pathlib.Path(source + ".bin").read_bytes(), 0, []
    for topic, name, time, size in json.loads(pathlib.Path(source + ".json").read_text(encoding="utf-8")):
        messages.append((topic, name, time, blob[place:place + size]))
        place += size
    if not kind:
        write(out, messages)
        return
    out.mkdir(parents=True, exist_ok=True)
    if kind == "packed":
        write(out / "bag_0.db3", messages, zstd)
        subprocess.run(["zstd", "-q", "-f", "--rm", out / "bag_0.db3", "-o", out / "bag_0.db3.zstd"], check=True)
        return
    half = len(messages) // 2
    write(out / "bag_0.db3", messages[:half])
    write(out / "bag_1.db3", messages[half:])
    (out / "metadata.yaml").write_text(
        "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  relative_file_paths:\n"
        f"    - bag_0.db3\n    - bag_1.db3\n  message_count: {len(messages)}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
