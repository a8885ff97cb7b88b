#include "abi/status.h"

namespace beltrami {
namespace {

struct Status {
  beltrami_status number;
  const char* name;
  const char* advice;
};

#define BELTRAMI_STATUS(name, advice) \
  { BELTRAMI_##name, "BELTRAMI_" #name, advice }
constexpr Status kStatuses[] = {
    BELTRAMI_STATUS(OK, "All promises were kept; there is nothing to do."),
    BELTRAMI_STATUS(NOT_CONVERGED,
                    "The map is injective, but an optimisation stopped at its iteration limit: "
                    "raise max-iterations or tolerance for less distortion."),
    BELTRAMI_STATUS(
        NOT_INJECTIVE,
        "The map has flipped or empty faces, or its boundary crosses itself: see the "
        "certificate for where, and try another method or the UVs in F64; where UVs are "
        "beyond the range of numbers, scale the mesh or set unit-square."),
    BELTRAMI_STATUS(NOT_INJECTIVE_FLOAT32,
                    "The map is injective in double precision, but no rounding to single precision "
                    "was found that is, or they are beyond its range: use the UVs in F64 or the "
                    "option unit-square, or cut the mesh into smaller charts."),
    BELTRAMI_STATUS(E_INVALID_ARGUMENT,
                    "The call itself is wrong: check it for NULL, an unset struct_size, an unknown "
                    "key, a value out of range, or an odd type or stride."),
    BELTRAMI_STATUS(E_OUT_OF_MEMORY,
                    "There is not enough memory: free some, or flatten a mesh with fewer faces."),
    BELTRAMI_STATUS(E_ABI_MISMATCH,
                    "The program was compiled against another binary interface than the library's: "
                    "rebuild it with the header of this library."),
    BELTRAMI_STATUS(E_UNSUPPORTED,
                    "This build of the library lacks what was asked for: ask beltrami_has first, "
                    "or use a build that has it."),
    BELTRAMI_STATUS(E_INVALID_STATE,
                    "The call comes too early or during a run: set a mesh and run first, and wait "
                    "for a run to end."),
    BELTRAMI_STATUS(E_CANCELLED,
                    "The run was cancelled on request: run again when you need the result."),
    BELTRAMI_STATUS(E_INTERNAL,
                    "This is a defect of the library: please report it together with the mesh."),
    BELTRAMI_STATUS(E_EMPTY,
                    "The mesh has no vertices or no faces: give it at least one triangle."),
    BELTRAMI_STATUS(E_INDEX_OUT_OF_RANGE,
                    "A face names a vertex that does not exist: indices count from 0 and end below "
                    "the vertex count."),
    BELTRAMI_STATUS(E_NON_FINITE,
                    "A coordinate is infinite or not a number: repair or remove that vertex."),
    BELTRAMI_STATUS(E_REPEATED_VERTEX, "A face names one vertex twice: remove the face."),
    BELTRAMI_STATUS(E_NON_MANIFOLD_EDGE,
                    "An edge has more than two faces: split the surface there."),
    BELTRAMI_STATUS(E_NON_MANIFOLD_VERTEX,
                    "The faces of a vertex form more than one fan: duplicate the vertex, one copy "
                    "for each fan."),
    BELTRAMI_STATUS(E_ORIENTATION,
                    "A face runs against its neighbour or is a duplicate: orient all faces alike "
                    "and remove duplicates."),
    BELTRAMI_STATUS(E_COMPONENTS, "The mesh has more than one component: flatten each on its own."),
    BELTRAMI_STATUS(E_CLOSED, "The surface is closed: cut it open along a seam first."),
    BELTRAMI_STATUS(E_BOUNDARIES,
                    "The surface has more than one boundary loop: fill the holes, or cut from each "
                    "to the boundary."),
    BELTRAMI_STATUS(E_GENUS, "The surface has handles: cut them open first."),
    BELTRAMI_STATUS(E_ZERO_AREA,
                    "The whole surface has no area, or too much for a number: check the vertex "
                    "positions."),
    BELTRAMI_STATUS(E_PINS,
                    "Pins ask for what no injective map was found to do: move or drop the corner "
                    "named, or cut a seam."),
    BELTRAMI_STATUS(E_NO_ROOM,
                    "The charts do not fit onto the pages: raise max-pages or resolution, or lower "
                    "texels-per-unit or margin."),
    BELTRAMI_STATUS(E_SOLVER,
                    "A linear system could not be solved: remove degenerate faces, or try another "
                    "method."),
};
#undef BELTRAMI_STATUS

const Status* find(beltrami_status number) {
  for (const Status& status : kStatuses) {
    if (status.number == number) return &status;
  }
  return nullptr;
}

}  // namespace

const char* status_name(beltrami_status number) {
  const Status* status = find(number);
  return status != nullptr ? status->name : "unknown";
}

const char* status_advice(beltrami_status number) {
  const Status* status = find(number);
  return status != nullptr ? status->advice
                           : "This is no status of this library: the program may be newer than it.";
}

}  // namespace beltrami
