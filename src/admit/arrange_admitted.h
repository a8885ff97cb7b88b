// The order of an admitted surface in memory.
#pragma once

#include "admit/admit.h"
#include "base/work.h"

namespace beltrami {

/// Numbers the vertices and faces of the surface by where they are, so that neighbours lie close in
/// memory: they are no longer in the order of the input's.
void arrange_admitted(Admitted& admitted, const Work& work);

}  // namespace beltrami
