# A cloud of COUNT small sheets, askew, of which every tenth emits: no rectangle is large enough to hide anything, and no shaft
# longer than a few of them is empty.
function draw() { state = (state * 16807) % 2147483647; return state / 2147483647 }
function unit(v,   n) { do { for (k = 0; k < 3; k++) v[k] = 2 * draw() - 1; n = v[0]^2 + v[1]^2 + v[2]^2 } while (n > 1 || n < 0.01); for (k = 0; k < 3; k++) v[k] /= sqrt(n) }
BEGIN {
    state = 20001; print "mtllib specks.mtl"
    for (i = 0; i < COUNT; i++) {
        print "usemtl " (i % 10 ? "grey" : "lamp")
        for (k = 0; k < 3; k++) p[k] = draw()
        unit(u); unit(v)
        for (c = 0; c < 3; c++) {
            printf "v"
            for (k = 0; k < 3; k++) printf " %.9f", p[k] + SIZE * ((c == 1) * u[k] + (c == 2) * v[k])
            print ""
        }
        print "f -3 -2 -1"
    }
}
