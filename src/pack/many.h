// The density at which many charts fill a page, in a few layouts.
#pragma once

#include "pack/problem.h"

namespace beltrami {

/// Packs charts of which there are too many to try orders, onto one page. A layout on a grid of
/// half as many cells tells about at which density the page is full; then few are made, and the
/// best is taken. One that is a little higher than the page is brought to it with all its charts:
/// margins are drawn that much larger. Throws Error INVALID_ARGUMENT where margins alone take more
/// than the page. Precondition: no chart is kept, and one has a length.
Packed pack_many(const Problem& problem);

}  // namespace beltrami
