// Rows of the option table: what is asked of the maps of charts.
#pragma once

#include <beltrami/beltrami.h>

#include <iterator>

#include "abi/option_entry.h"
#include "abi/option_members.h"
#include "abi/options.h"

namespace beltrami {

inline constexpr const char* kStacks[] = {"none", "copies", "mirrored", "halves"};

inline constexpr OptionEntry kStack = {
    .key = BELTRAMI_OPTION_STACK,
    .type = BELTRAMI_TYPE_CHOICE,
    .name = "stack",
    .summary =
        "Whether components of one shape share texels. none: no. copies: those that a rigid motion "
        "carries onto one before them lie on its charts. mirrored: mirror images do, too. halves: "
        "what is symmetric is cut along its plane, where edges lie in that, and one half lies on "
        "the other. Not with pins, max-charts, seam-budget or symmetric-seams.",
    .minimum = 0,
    .maximum = std::size(kStacks) - 1,
    .choices = kStacks,
    .get = get<&Options::stack>,
    .set = set<&Options::stack>,
    .calls = BELTRAMI_CALL_UNWRAP,
};

inline constexpr const char* kRectifies[] = {"none", "grids"};

inline constexpr OptionEntry kRectify = {
    .key = BELTRAMI_OPTION_RECTIFY,
    .type = BELTRAMI_TYPE_CHOICE,
    .name = "rectify",
    .summary =
        "Which charts become rectangles along the axes: none, or grids. These are rows and columns "
        "of quads, as roads, tubes and cloths have: each column gets one width and each row one "
        "height.",
    .minimum = 0,
    .maximum = std::size(kRectifies) - 1,
    .choices = kRectifies,
    .get = get<&Options::rectify>,
    .set = set<&Options::rectify>,
    .calls = BELTRAMI_CALL_UNWRAP,
};

inline constexpr OptionEntry kSnapTexels = {
    .key = BELTRAMI_OPTION_SNAP_TEXELS,
    .type = BELTRAMI_TYPE_INT,
    .name = "snap-texels",
    .summary =
        "1 turns each chart to the most of its border that is straight, then by quarters alone, "
        "and moves straight borders onto the edges of texels. Lightmaps and pixel art want that. "
        "Nothing moves by more than half a texel, and charts keep a texel more room.",
    .minimum = 0,
    .maximum = 1,
    .get = get<&Options::snap_texels>,
    .set = set<&Options::snap_texels>,
    .calls = BELTRAMI_CALL_UNWRAP,
};

inline constexpr OptionEntry kLabelPages = {
    .key = BELTRAMI_OPTION_LABEL_PAGES,
    .type = BELTRAMI_TYPE_INT,
    .name = "label-pages",
    .summary =
        "1 puts charts of faces with different labels on different pages, in the order of the "
        "labels, as tiles of UDIM by material. All have one density, and max-pages counts the "
        "pages of each label.",
    .minimum = 0,
    .maximum = 1,
    .get = get<&Options::label_pages>,
    .set = set<&Options::label_pages>,
    .calls = BELTRAMI_CALL_UNWRAP,
};

}  // namespace beltrami
