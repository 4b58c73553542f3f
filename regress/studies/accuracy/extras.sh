# What each extra costs and buys: its error and CPU time over those of the default at spacing .1 (half-space scenes; the last
# line of a method, but the third of layer-12, which goes on to .071).
extras() {
    echo '| extra, spacing .1: error / default, CPU / default | smooth | kinked | gaussian |'
    echo '|---|---|---|---|'
    for method in vc2 vc1 degree1 degree3 mapped no-transform depth-mass-same dissipation low-pass layer-12 lysmer; do
        printf '| %s |' "$method"
        for scene in smooth kinked gaussian; do
            awk -v m="$method" '$1 == "default" { e = $3; c = $4 } $1 == m && (m != "layer-12" || ++n == 3) { error = $3; cpu = $4 }
                END { if (error) printf " %.2g, %.2g |", error / e, cpu / c; else printf " - |" }' "$out/$scene.txt"
        done
        echo
    done
}
