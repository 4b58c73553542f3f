#!/bin/sh
# The rooms of src/ (its folders) and which includes which: fails if some include each other in a circle, or if the graph
# in doc/developers/rooms.md is another. `sh regress/checks/rooms.sh graph` prints the graph for that page (Mermaid): each room with
# the rooms that it includes, but for those that it reaches through others.
cd "$(dirname "$0")/../.." || exit 1
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

# "from to" for each pair of rooms of which one includes the other; files in src itself are the room "src"
find src -name '*.[ch]' | xargs grep -H '^#include "' | sed 's|^src/||; s|:#include "| |; s|"$||' | while read -r file header; do
    [ -e "src/$header" ] && echo "$(dirname "$file") $(dirname "$header")"
done | sed 's/^\. /src /; s/ \.$/ src/' | awk '$1 != $2' | sort -u >"$work/edges"

graph() {
    echo 'flowchart TD'
    awk '{ from[NR] = $1; to[NR] = $2 }
        function reaches(a, b, direct, k) { # from room a to room b; without the direct step if `direct`
            for (k = 1; k <= NR; k++)
                if (from[k] == a && !(direct && to[k] == b) && (to[k] == b || reaches(to[k], b, 0))) return 1
            return 0
        }
        function node(room, name) { name = room; gsub("/", "_", name); return name "[" room "]" }
        END { for (i = 1; i <= NR; i++) if (!reaches(from[i], to[i], 1)) print "    " node(from[i]) " --> " node(to[i]) }' "$work/edges"
}

if tsort "$work/edges" >/dev/null 2>"$work/circle"; then
    if [ "${1:-}" = graph ]; then graph; exit; fi
    echo "ok - no rooms of src/ include each other in a circle"
    if graph | grep -v flowchart | grep -vxF -f doc/developers/rooms.md >"$work/missing" || [ "$(graph | wc -l)" != "$(sed -n '/^flowchart/,/^```/p' doc/developers/rooms.md | grep -vc '^```')" ]; then
        echo "not ok - doc/developers/rooms.md shows the graph of the rooms"
        echo "#   it differs from: sh regress/checks/rooms.sh graph"
        sed 's/^/#   missing: /' "$work/missing"
        exit 1
    fi
    echo "ok - doc/developers/rooms.md shows the graph of the rooms"
else
    echo "not ok - rooms of src/ include each other in a circle"
    sed 's/^/#   /' "$work/circle"
    exit 1
fi
