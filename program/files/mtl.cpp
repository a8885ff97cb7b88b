#include "files/mtl.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "files/encoding.h"
#include "files/inside_folder.h"
#include "files/polygons.h"
#include "process/descriptor.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

constexpr std::string_view kBlanks = " \t\r";

/// Takes the first word off.
std::string_view take_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return word;
}

std::string_view without_blanks_behind(std::string_view text) {
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::string lower(std::string_view text) {
  std::string found(text);
  for (char& c : found) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return found;
}

/// What statements of textures mean; reflections (refl) do not follow UVs.
std::optional<Meaning> meaning_of(const std::string& keyword) {
  if (keyword == "map_kd") return Meaning::kTransparent;
  if (keyword == "map_ke" || keyword == "map_ka" || keyword == "map_ks") return Meaning::kColours;
  if (keyword == "norm" || keyword == "map_kn") return Meaning::kDirections;
  if (keyword == "bump" || keyword == "map_bump") return Meaning::kRelief;
  if (keyword.starts_with("map_") && keyword != "map_aat") return Meaning::kNumbers;
  if (keyword == "disp" || keyword == "decal") return Meaning::kNumbers;
  return std::nullopt;
}

std::optional<double> number_of(std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// How many words follow an option: -1 for up to three numbers.
int words_after(std::string_view option) {
  if (option == "-o" || option == "-s" || option == "-t") return -1;
  if (option == "-mm") return 2;
  constexpr std::array<std::string_view, 8> kOne = {"-blendu", "-blendv", "-cc",      "-clamp",
                                                    "-bm",     "-boost",  "-imfchan", "-texres"};
  if (std::find(kOne.begin(), kOne.end(), option) != kOne.end()) return 1;
  return option == "-type" || option == "-colorspace" ? 1 : 0;
}

std::vector<std::string> names_of(const MeshFile& file, std::string_view names) {
  // A name may have blanks, and there may be several names: the files that there are say which.
  std::vector<std::string> words;
  bool several = false;
  for (std::string_view rest = names; !rest.empty();) {
    words.emplace_back(take_word(rest));
    std::error_code ignored;
    const NamedFile named = follow_name(file.path, words.back(), file.reach);
    several = several || (!named.path.empty() && std::filesystem::exists(named.path, ignored));
  }
  if (words.size() > 1 && several) return words;
  return {std::string(without_blanks_behind(names))};
}

/// The name of a material that a statement gives the faces behind it.
std::optional<std::string> name_in_use(const Statement& statement) {
  std::string_view rest = statement.in_file();
  if (take_word(rest) != "usemtl" || rest.empty()) return std::nullopt;
  return std::string(without_blanks_behind(rest));
}

}  // namespace

MaterialLibraries::MaterialLibraries(const MeshFile& file, bool strict) : file_(file) {
  for (const Statement& statement : file.statements) {
    std::string_view rest = statement.in_file();
    if (take_word(rest) != "mtllib") continue;
    for (const std::string& name : names_of(file, rest)) {
      const NamedFile named = follow_name(file.path, name, file.reach);
      try {
        if (named.path.empty()) {
          throw Failure(file.path + ": '" + one_line(name) + "' " + named.refusal);
        }
        read_library(named.path);
      } catch (const Failure& failure) {
        if (strict || failure.exit_code == kExitCancelled) throw;
        unread_.emplace_back(failure.what());
      }
    }
  }
  add_unlisted();
}

void MaterialLibraries::read_library(const std::string& path) {
  if (std::find(libraries_.begin(), libraries_.end(), path) != libraries_.end()) return;
  const std::string bytes = read_file(path);
  libraries_.push_back(path);
  std::string_view left = bytes;
  while (!left.empty()) {
    const std::size_t end = std::min(left.find('\n'), left.size());
    std::string_view rest = without_blanks_behind(left.substr(0, end));
    left.remove_prefix(std::min(end + 1, left.size()));
    Line line;
    line.text = rest;
    const std::string keyword(take_word(rest));
    if (keyword == "newmtl") {
      materials_.push_back({utf8_of(rest), path, std::string(rest), {}});
      continue;
    }
    if (materials_.empty()) continue;  // comments
    if (meaning_of(lower(keyword))) {
      line.keyword = keyword;
      while (rest.starts_with('-')) {
        std::string option(take_word(rest));
        const int count = words_after(option);
        std::array<double, 3> numbers =
            option == "-s" ? std::array{1.0, 1.0, 1.0} : std::array{0.0, 0.0, 0.0};
        std::string text = option;
        for (int i = 0; i < (count < 0 ? 3 : count) && !rest.empty(); ++i) {
          std::string_view after = rest;
          const std::string_view word = take_word(after);
          const std::optional<double> number = number_of(word);
          if (count < 0 && !number) break;
          if (count < 0) numbers[static_cast<std::size_t>(i)] = *number;
          if (option == "-clamp") line.clamps = word == "on";
          if (option == "-imfchan") line.channel = word.front();
          text += ' ' + std::string(word);
          rest = after;
        }
        if (option == "-s") {
          line.transform[0] = numbers[0];
          line.transform[4] = numbers[1];
        } else if (option == "-o") {
          line.transform[2] = numbers[0];
          line.transform[5] = numbers[1];
        } else if (option != "-clamp") {
          line.options += text + ' ';
        }
      }
      line.name = rest;
    }
    materials_.back().lines.push_back(std::move(line));
  }
}

/// What statements of `file` name, and no library has.
void MaterialLibraries::add_unlisted() {
  for (std::uint64_t i = 0; i < materials_.size(); ++i) {
    first_of_name_.try_emplace(materials_[i].bytes, i);
  }
  for (const Statement& statement : file_.statements) {
    const std::optional<std::string> name = name_in_use(statement);
    if (!name || !first_of_name_.try_emplace(*name, materials_.size()).second) continue;
    materials_.push_back({utf8_of(*name), {}, *name, {}});
  }
}

std::vector<bool> MaterialLibraries::materials_in_use() const {
  std::vector<bool> used(materials_.size(), false);
  for (const std::uint64_t material : material_of_faces()) {
    if (material != kNone) used[material] = true;
  }
  return used;
}

std::vector<std::uint64_t> MaterialLibraries::material_of_faces() const {
  std::vector<std::uint64_t> found(file_.polygons.size(), kNone);
  std::uint64_t first = 0, material = kNone;
  const auto fill_to = [&](std::uint64_t end) {
    for (; first < end && first < found.size(); ++first) found[first] = material;
  };
  for (const Statement& statement : file_.statements) {
    throw_if_interrupted();
    std::string_view rest = statement.text;
    if (take_word(rest) != "usemtl") continue;
    fill_to(statement.polygon);
    const std::optional<std::string> name = name_in_use(statement);
    material = name ? first_of_name_.at(*name) : kNone;
  }
  fill_to(found.size());
  return found;
}

std::string MaterialLibraries::slot(const Material& material, const Line& line) const {
  const auto number = &material - materials_.data();
  return std::to_string(number) + " " + std::to_string(&line - material.lines.data());
}

std::string MaterialLibraries::value(std::uint64_t material, std::string_view keyword) const {
  for (const Line& line : materials_[material].lines) {
    std::string_view rest = line.text;
    if (lower(take_word(rest)) == keyword) return std::string(rest);
  }
  return {};
}

std::vector<TextureUse> MaterialLibraries::textures_of(std::uint64_t number) const {
  std::vector<TextureUse> uses;
  const Material& material = materials_[number];
  for (const Line& line : material.lines) {
    if (line.keyword.empty() || line.name.empty()) continue;
    TextureUse& use = uses.emplace_back();
    use.name = line.keyword + " of material '" + one_line(material.name) + "'";
    use.stem = material.name + "_" + lower(line.keyword);
    use.keyword = lower(line.keyword);
    use.channel = line.channel;
    use.material = number;
    use.slots = {slot(material, line)};
    use.image = line.name;
    use.transform = line.transform;
    const Beyond beyond = line.clamps ? Beyond::kClamp : Beyond::kRepeat;
    use.reading = {beyond, beyond};
    use.meaning = *meaning_of(use.keyword);
  }
  return uses;
}

std::vector<TextureUse> MaterialLibraries::textures() const {
  std::vector<TextureUse> uses;
  const std::vector<bool> used = materials_in_use();
  for (std::uint64_t i = 0; i < materials_.size(); ++i) {
    if (!used[i]) continue;
    const auto first = static_cast<std::ptrdiff_t>(uses.size());
    for (TextureUse& use : textures_of(i)) {
      const auto same =
          std::find_if(uses.begin() + first, uses.end(), [&](const TextureUse& known) {
            return known.image == use.image && known.meaning == use.meaning &&
                   known.transform == use.transform && known.reading.along_u == use.reading.along_u;
          });
      if (same != uses.end()) {
        same->slots.push_back(use.slots.front());
      } else {
        uses.push_back(std::move(use));
      }
    }
  }
  return uses;
}

std::string MaterialLibraries::image_path(const TextureUse& use) const {
  const std::string& library = materials_[use.material].library;
  NamedFile named = follow_name(library, use.image, file_.reach);
  if (named.path.empty()) {
    throw Failure(library + ": '" + one_line(use.image) + "' " + named.refusal);
  }
  return std::move(named.path);
}

std::vector<std::string> MaterialLibraries::sources() const {
  std::vector<std::string> found = libraries_;
  for (const Material& material : materials_) {
    for (const Line& line : material.lines) {
      if (line.name.empty()) continue;
      NamedFile named = follow_name(material.library, line.name, file_.reach);
      if (!named.path.empty()) found.push_back(std::move(named.path));
    }
  }
  return found;
}

std::string MaterialLibraries::text(const std::vector<BakedTexture>& baked) const {
  std::string text = "# Textures by beltrami, for the UVs of the model beside\n";
  for (const Material& material : materials_) {
    if (material.library.empty()) continue;  // of its name alone there is nothing to write
    text += "newmtl " + material.bytes + "\n";
    for (const Line& line : material.lines) {
      const std::string own = slot(material, line);
      const auto found = std::find_if(baked.begin(), baked.end(), [&](const BakedTexture& texture) {
        const std::vector<std::string>& slots = texture.use.slots;
        return std::find(slots.begin(), slots.end(), own) != slots.end();
      });
      text += found == baked.end() ? line.text
                                   : line.keyword + " " + line.options + "-clamp on " + found->uri;
      text += '\n';
    }
  }
  return text;
}

void MaterialLibraries::name_library(MeshFile& file, const std::string& name) {
  bool named = false;
  std::vector<Statement> statements;
  for (Statement& statement : file.statements) {
    std::string_view rest = statement.text;
    if (take_word(rest) == "mtllib") {
      if (named) continue;
      named = true;
      statement.text = "mtllib " + name;
      statement.leads_on = true;
    }
    statements.push_back(std::move(statement));
  }
  file.statements = std::move(statements);
}

}  // namespace beltrami::cli
