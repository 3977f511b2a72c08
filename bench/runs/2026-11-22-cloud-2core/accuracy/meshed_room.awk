# A closed cube of side 4, CELLS quads along an edge, in which with BLOCK > 0 a cube of side 1 hangs, BLOCK quads along an edge.
# With GLOW=1 every surface glows: all of them then have the radiosity pi Ke / (1 - Kd), however they stand. Otherwise a lamp of
# 0.8 by 0.8 shines under the ceiling.
function plate(o, a, b, n,   i, j, k, c, s, t) {
    for (i = 0; i < n; i++) for (j = 0; j < n; j++) {
        for (c = 0; c < 4; c++) {
            s = (i + (c == 1 || c == 2)) / n; t = (j + (c > 1)) / n
            printf "v"
            for (k = 1; k <= 3; k++) printf " %.9g", o[k] + a[k] * s + b[k] * t
            print ""
        }
        print "f -4 -3 -2 -1"
    }
}
# Six sides of the cube from lo to hi, their fronts inward or outward.
function cube(lo, hi, n, inward,   x, high, y, z, k) {
    for (x = 1; x <= 3; x++) for (high = 0; high < 2; high++) {
        y = x % 3 + 1; z = y % 3 + 1
        for (k = 1; k <= 3; k++) { o[k] = lo; a[k] = 0; b[k] = 0 }
        if (high) o[x] = hi
        if (high == inward) { a[z] = hi - lo; b[y] = hi - lo } else { a[y] = hi - lo; b[z] = hi - lo }
        plate(o, a, b, n)
    }
}
BEGIN {
    print "mtllib meshed_room.mtl\nusemtl wall"
    cube(0, 4, CELLS, 1)
    if (BLOCK) cube(1.5, 2.5, BLOCK, 0)
    printf "newmtl wall\nKd 0.8 0.8 0.8\nKe %g %g %g\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n", GLOW, GLOW, GLOW > "meshed_room.mtl"
    if (GLOW) exit
    print "usemtl lamp"
    split("1.6 1.6 3.9", o); split("0 0.8 0", a); split("0.8 0 0", b)
    plate(o, a, b, 1)
}
