#include "commands/pages.h"

#include <algorithm>
#include <filesystem>

#include "commands/command.h"
#include "commands/tiles.h"
#include "picture/stb_in_one_place.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

void require(beltrami_context* context, beltrami_status status) {
  require_ok(status, "the pages", beltrami_error_message(context), BELTRAMI_ELEMENT_NONE,
             BELTRAMI_NO_ELEMENT);
}

std::uint8_t grey_of(std::uint8_t texel) {
  return texel == BELTRAMI_TEXEL_COVERED ? 255 : texel == BELTRAMI_TEXEL_GUTTER ? 128 : 0;
}

beltrami_packing packing_of(beltrami_context* context) {
  beltrami_packing packing{};
  packing.struct_size = sizeof packing;
  require(context, beltrami_get_packing(context, &packing));
  return packing;
}

}  // namespace

std::string path_of_page(const std::string& path, std::uint64_t page) {
  const bool is_picture = std::filesystem::path(path).extension() == ".png";
  return texture_of_page(is_picture ? path : path + ".png", page);
}

std::string texture_of_page(const std::string& path, std::uint64_t page) {
  std::filesystem::path name(path);
  const std::string extension = name.extension().string();
  name.replace_extension();
  const std::string first = '.' + std::to_string(kFirstTile);
  if (name.extension() == first) name.replace_extension();
  return name.string() + '.' + std::to_string(kFirstTile + page) + extension;
}

void report_pages(beltrami_context* context, Report& report) {
  report.packing = packing_of(context);
  report.page_utilisations.assign(report.packing->pages, 0);
  require(context, beltrami_get_page_utilisations(context, report.page_utilisations.data(),
                                                  BELTRAMI_F64, 0));
}

std::uint64_t PagesOfLabels::number(const std::string& name) {
  const auto [place, is_new] = numbers_.emplace(name, numbers_.size());
  if (is_new) {
    pages_.push_back({name, 0, 0});
    has_page_.push_back(false);
  }
  return place->second;
}

void PagesOfLabels::add(std::uint64_t label, std::uint64_t page) {
  auto& [name, first, last] = pages_[label];
  first = has_page_[label] ? std::min(first, page) : page;
  last = std::max(last, page);
  has_page_[label] = true;
}

std::vector<LabelPages> PagesOfLabels::taken() const {
  std::vector<LabelPages> all;
  for (std::size_t i = 0; i < pages_.size(); ++i) {
    if (has_page_[i]) all.push_back(pages_[i]);
  }
  std::sort(all.begin(), all.end(),
            [](const LabelPages& a, const LabelPages& b) { return a.first < b.first; });
  return all;
}

void write_masks(beltrami_context* context, const std::string& base,
                 std::deque<AtomicFile>& outputs) {
  const beltrami_packing packing = packing_of(context);
  const auto side = static_cast<int>(packing.resolution);
  std::vector<std::uint8_t> texels(packing.resolution * packing.resolution);
  for (std::uint64_t page = 0; page < packing.pages; ++page) {
    throw_if_interrupted();
    require(context, beltrami_get_page_mask(context, page, texels.data(), 0));
    for (std::uint8_t& texel : texels) texel = grey_of(texel);
    AtomicFile& file = outputs.emplace_back(path_of_page(base, page));
    file.write(png_bytes(side, side, 1, texels.data()));
    file.close();
  }
}

}  // namespace beltrami::cli
