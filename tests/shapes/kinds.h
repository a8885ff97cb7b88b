// The kinds of shapes: each a function of random numbers alone.
#pragma once

#include "shapes/random.h"
#include "shapes/shape.h"

namespace beltrami::shapes {

// Flat ones: flat_kinds.cpp.
Shape flat_ring(Random& random);   ///< between two crooked polygons of 4 to 100 corners
Shape frame(Random& random);       ///< rectangles in rectangles
Shape plate(Random& random);       ///< with holes, cut into triangles as CAD does it
Shape letter(Random& random);      ///< and words of them
Shape disc(Random& random);        ///< polygons as one face or as a fan; combs, stars
Shape t_vertices(Random& random);  ///< rectangles whose corners lie on others' sides
Shape spiral(Random& random);      ///< a long strip that winds round itself

// Solids: solid_kinds.cpp.
Shape prism(Random& random);
Shape block(Random& random);  ///< with holes drilled through it
Shape solid_letter(Random& random);
Shape blob(Random& random);   ///< a noisy sphere
Shape torus(Random& random);  ///< of one or several rings
Shape voxels(Random& random);
Shape lattice(Random& random);  ///< bars along all edges of a grid

// Torn, twisted and thin ones: odd_kinds.cpp.
Shape sliver(Random& random);
Shape needle(Random& random);
Shape soup(Random& random);        ///< triangles that have nothing to do with each other
Shape chaos(Random& random);       ///< triangles of few vertices, by chance
Shape copies(Random& random);      ///< of one shape, in one place or beside each other
Shape crumbs(Random& random);      ///< a shape among tiny ones
Shape twisted(Random& random);     ///< bands of any number of half turns: Moebius's, and a bottle
Shape book(Random& random);        ///< more than two faces at an edge
Shape hub(Random& random);         ///< fans that meet in one vertex
Shape ribbon(Random& random);      ///< crumpled
Shape degenerate(Random& random);  ///< points, lines, faces that name a vertex twice

}  // namespace beltrami::shapes
