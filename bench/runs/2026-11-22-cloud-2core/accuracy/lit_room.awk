# A closed, empty room of 4 x 2.5 x 4 whose walls are 3 x 3 panels; the middle one of the ceiling is the lamp. Nothing hides anything.
function corner(x, y, z) { printf "v %g %g %g\n", x, y, z }
function panel(i, j, axis, high,   k, u, v, p) {
    # Corners counter-clockwise seen from inside, from cell i, j across the two other axes.
    for (k = 0; k < 4; k++) {
        u = i + (k == 1 || k == 2); v = j + (k > 1)
        p[(axis + 1) % 3] = high ? cut[(axis + 1) % 3, i + i + 1 - u] : cut[(axis + 1) % 3, u]
        p[(axis + 2) % 3] = cut[(axis + 2) % 3, v]
        p[axis] = high ? cut[axis, 3] : 0
        corner(p[0], p[1], p[2])
    }
    print "f -4 -3 -2 -1"
}
BEGIN {
    print "mtllib lit_room.mtl"
    for (k = 0; k <= 3; k++) {
        split("0 1.5 2.5 4", wide, " "); split("0 0.9 1.6 2.5", tall, " ")
        cut[0, k] = cut[2, k] = wide[k + 1]; cut[1, k] = tall[k + 1]
    }
    for (axis = 0; axis < 3; axis++) for (high = 0; high < 2; high++)
        for (i = 0; i < 3; i++) for (j = 0; j < 3; j++) {
            print "usemtl " (axis == 1 && high && i == 1 && j == 1 ? "lamp" : "wall")
            panel(i, j, axis, high)
        }
}
