#!/bin/sh
# selas check --plot: the picture is there before anything is computed, for each kind of ground, of the size its
# panels need; a file that is no result is not overwritten; what has no such picture is refused. Usage: ground-plots.sh BUILD
build=$(cd "${1:-build}" && pwd)
here=$(dirname "$0")
. "$here/parts/report.sh"
