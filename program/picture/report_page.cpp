#include "picture/report_page.h"

namespace beltrami::cli {
namespace {

constexpr unsigned char kReportPage[] = {
#include "report_page.inc"
};

}  // namespace

std::string_view report_page() {
  return {reinterpret_cast<const char*>(kReportPage), sizeof kReportPage};
}

}  // namespace beltrami::cli
