# Table 4: the plate with a hole against finite elements. Sourced by regress/studies/tables/run.
. regress/studies/tables/plate.sh

# plate_mesh RADIUS AROUND OUTWARD: CalculiX input of the quarter plate, bilinear plane-stress quadrilaterals graded to
# the hole, the upper edge moved by 1e-6 with slip; thin against the mesh, because CalculiX expands them into space.
plate_mesh() {
    awk -v R="$1" -v na="$2" -v nr="$3" 'BEGIN {
        pi = 3.14159265358979
        print "*NODE, NSET=ALL"
        for (j = 0; j <= nr; j++) for (i = 0; i <= na; i++) {
            t = i * pi / 2 / na; c = cos(t); s = sin(t)
            big = c > s ? c : s; w = (exp(1.5 * j / nr) - 1) / (exp(1.5) - 1)
            printf "%d, %.12g, %.12g, 0\n", 1 + i + (na + 1) * j, R * c + w * (c / big - R * c), R * s + w * (s / big - R * s)
        }
        print "*ELEMENT, TYPE=CPS4, ELSET=PLATE"
        for (j = 0; j < nr; j++) for (i = 0; i < na; i++) {
            n = 1 + i + (na + 1) * j
            printf "%d, %d, %d, %d, %d\n", 1 + i + na * j, n, n + na + 1, n + na + 2, n + 1
        }
        print "*MATERIAL, NAME=M\n*ELASTIC\n45e9, .35\n*SOLID SECTION, ELSET=PLATE, MATERIAL=M\n1e-4\n*BOUNDARY"
        for (j = 0; j <= nr; j++) { printf "%d, 2, 2\n%d, 1, 1\n", 1 + (na + 1) * j, 1 + na + (na + 1) * j }
        print "*STEP\n*STATIC\n*BOUNDARY"
        for (i = na / 2; i <= na; i++) printf "%d, 2, 2, 1e-6\n", 1 + i + (na + 1) * nr
        print "*EL FILE, OUTPUT=2D\nS\n*END STEP"
    }'
}
# ligament_of_mesh FRD RADIUS AROUND: rows "s x y syy" at 61 even points of y = 0
ligament_of_mesh() {
    awk -v R="$2" -v na="$3" '
        / -4  STRESS/ { block = 2 }
        / -4  / && !/STRESS/ { block = 0 }
        /^    2C/ { block = 1 }
        /^ -3/ { block = 0 }
        /^ -1/ && block == 1 { id = substr($0, 4, 10) + 0; px[id] = substr($0, 14, 12) + 0 }
        /^ -1/ && block == 2 { id = substr($0, 4, 10) + 0; syy[id] = substr($0, 26, 12) + 0 }
        END {
            for (id = 1; id in px; id += na + 1) { x[++n] = px[id]; s[n] = syy[id] }
            for (p = 0; p <= 60; p++) {
                at = R + (1 - R) * p / 60
                for (k = 1; k + 1 < n && x[k + 1] < at;) k++
                print p, at, 0, s[k] + (s[k + 1] - s[k]) * (at - x[k]) / (x[k + 1] - x[k])
            }
        }' "$1"
}
mesh_row() { # mesh_row RADIUS AROUND OUTWARD PAPER_L1 PAPER_L2 PAPER_NODES
    name="finite elements, CalculiX (paper: $6 nodes)"
    if ! command -v ccx >/dev/null; then
        echo "| $1 | $name | $4 | $5 | not run: ccx is not installed | | | | | | |"
        return
    fi
    plate_mesh "$1" "$2" "$3" >"$out/mesh.inp"
    (cd "$out" && ccx -i mesh >mesh.log 2>&1)
    ligament_of_mesh "$out/mesh.frd" "$1" "$2" >"$out/mesh.dat"
    set -- "$1" "$2" "$3" "$4" "$5" $(hole_error "$out/mesh.dat" 4 "$1" infinite) \
        $(hole_error "$out/mesh.dat" 4 "$1" "regress/reference/hole/R0.${1#.}_disp.csv")
    echo "| $1 | $name | $4 | $5 | $((($2 + 1) * ($3 + 1))) | $6 | $7 | $8 | $9 | | |"
}
table4() {
    echo '## Table 4: the plate with a hole, particles and finite elements'
    echo
    echo 'Errors as in Table 3. The finite elements are the static plate, bilinear quadrilaterals, run here.'
    echo
    echo '| R | run | paper L1 | paper L2 | points or nodes | L1 infinite | L2 infinite | L1 finite | L2 finite | CPU | particle evaluations |'
    echo '|---|---|---|---|---|---|---|---|---|---|---|'
    mesh_row .2 54 58 .0521 .0537 3222
    mesh_row .3 54 54 .6799 .8084 3025
    for row in '.2 .0304 .0442 .0203' '.3 .0272 .0357 .0202'; do
        # shellcheck disable=SC2086
        set -- $row
        # shellcheck disable=SC2086
        echo "| $1 | updated, equally radial, as published | $2 | $3 | $(plate plate "$1" body%arrangement=equally-radial "body%spacing=$4" $published)"
        # shellcheck disable=SC2086
        echo "| $1 | updated, conformal, settled | | | $(plate plate "$1" body%arrangement=conformal "body%spacing=$4" $settled)"
        echo "| $1 | total (quadratic), conformal, settled | | | $(plate plate "$1" body%arrangement=conformal "body%spacing=$4")"
    done
}
