// The viewer of program/viewer as one page, with places for what it shows.
#pragma once

#include <string_view>

namespace beltrami::cli {

/// A page of HTML that needs nothing else: kReportPlace stands once where JSON is to come, and
/// after it once kArraysPlace, where arrays are.
std::string_view report_page();

inline constexpr std::string_view kReportPlace = "@report@";
inline constexpr std::string_view kArraysPlace = "@arrays@";

}  // namespace beltrami::cli
