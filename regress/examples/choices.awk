# Adds the lines of the file `lines` to the ends of their lists: awk -f choices.awk lines src/deck/choices.h
FNR == 1 { list = "" }
FNR == NR { if ($1 !~ /^#/) { list = $1; sub(/^[^ ]* /, ""); added[list] = $0 } next }
/^#define/ { list = $2; sub(/\(.*/, "", list) }
{ last = $0 !~ /\\$/ }
last && list in added { print $0 " \\"; print "    " added[list]; delete added[list]; next }
{ print }
