#include "hashes/rows.h"

#include <beltrami/beltrami.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>

#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "multilevel/options.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/random_disks.h"

namespace beltrami::hashes {
namespace {

using meshes::TriangleList;

/// FNV-1a over the bits of numbers.
class Hash {
 public:
  void add(std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte, bits >>= 8) {
      state_ = (state_ ^ (bits & 0xff)) * 0x100000001b3;
    }
  }
  void add(double x) { add(std::bit_cast<std::uint64_t>(x)); }
  std::uint64_t value() const { return state_; }
  std::string text() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(state_));
    return text;
  }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325;
};

struct Setting {
  std::int32_t key;
  std::int64_t value;
};

struct Destroy {
  void operator()(beltrami_context* context) const { beltrami_destroy(context); }
};
using Context = std::unique_ptr<beltrami_context, Destroy>;

void require(beltrami_status status, const char* what) {
  if (status != BELTRAMI_OK) {
    throw std::runtime_error(std::string(what) + ": " + beltrami_status_name(status));
  }
}

/// "NAME" or "NAME=VALUE" for each word, as in the program's options but for the dashes.
std::vector<Setting> parse(const std::string& words) {
  std::vector<Setting> settings;
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(' ', begin), words.size());
    const std::string word = words.substr(begin, end - begin);
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::int32_t key = beltrami_option_find(word.substr(0, equals).c_str());
    if (key < 0) throw std::runtime_error("there is no option " + word);
    const std::string value = equals == word.size() ? "1" : word.substr(equals + 1);
    std::int32_t choice = 0;
    const char* name = nullptr;
    while ((name = beltrami_option_choice(key, choice)) != nullptr && value != name) ++choice;
    settings.push_back({key, name != nullptr ? choice : std::stoll(value)});
    begin = end + 1;
  }
  return settings;
}

void add_certificate(const beltrami_certificate& certificate, Hash& hash) {
  for (const std::uint64_t number :
       {certificate.positive, certificate.negative, certificate.degenerate,
        certificate.boundary_crossings, certificate.first_bad_face, certificate.first_crossing[0],
        certificate.first_crossing[1]}) {
    hash.add(number);
  }
}

/// What is delivered: both precisions, both certificates, the energies, and the faces of the map.
std::string describe(beltrami_context* context, beltrami_status status, const TriangleList& mesh,
                     Hash& hash) {
  const std::size_t vertices = mesh.positions.size(), faces = mesh.faces.size();
  std::vector<double> uvs(2 * vertices), energies(faces);
  std::vector<float> singles(2 * vertices);
  std::vector<std::uint64_t> indices(3 * faces);
  beltrami_certificate certificate{}, single{};
  beltrami_energy energy{};
  certificate.struct_size = single.struct_size = sizeof certificate;
  energy.struct_size = sizeof energy;
  require(beltrami_get_uvs(context, uvs.data(), BELTRAMI_F64, 0), "uvs");
  require(beltrami_get_uvs(context, singles.data(), BELTRAMI_F32, 0), "float32 uvs");
  require(beltrami_get_faces(context, indices.data(), BELTRAMI_U64, 0), "faces");
  require(beltrami_get_face_energies(context, energies.data(), 0), "face energies");
  require(beltrami_get_certificate(context, &certificate), "certificate");
  require(beltrami_get_float32_certificate(context, &single), "float32 certificate");
  require(beltrami_get_energy(context, &energy), "energy");
  hash.add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(status)));
  for (const double x : uvs) hash.add(x);
  for (const float x : singles) hash.add(static_cast<double>(x));
  for (const std::uint64_t index : indices) hash.add(index);
  for (const double x : energies) hash.add(x);
  add_certificate(certificate, hash);
  add_certificate(single, hash);
  hash.add(energy.symmetric_dirichlet);
  hash.add(energy.symmetric_arap);
  char text[120];
  std::snprintf(text, sizeof text, "%s  %llu+%llu+%llu  %.9g",
                beltrami_status_name(status) + sizeof "BELTRAMI",
                static_cast<unsigned long long>(certificate.negative),
                static_cast<unsigned long long>(certificate.degenerate),
                static_cast<unsigned long long>(certificate.boundary_crossings),
                energy.symmetric_dirichlet);
  return text;
}

/// Status, certificate and energy of a run; its bits are added to `hash`.
std::string run(const TriangleList& mesh, const std::vector<Setting>& settings, int threads,
                Hash& hash) {
  beltrami_context* created = nullptr;
  require(beltrami_create(&created), "context");
  const Context context(created);
  for (const auto& [key, value] : settings)
    require(beltrami_set_int(created, key, value), "option");
  require(beltrami_set_int(created, BELTRAMI_OPTION_THREADS, threads), "threads");
  beltrami_mesh view{};
  view.struct_size = sizeof view;
  view.vertex_count = mesh.positions.size();
  view.face_count = mesh.faces.size();
  view.positions = {mesh.positions.data(), 0, BELTRAMI_F64, 0};
  view.indices = {mesh.faces.data(), 0, BELTRAMI_U32, 0};
  require(beltrami_set_mesh(created, &view), "mesh");
  const beltrami_status status = beltrami_run(created, nullptr, nullptr);
  if (status >= BELTRAMI_OK) return describe(created, status, mesh, hash);
  hash.add(static_cast<std::uint64_t>(static_cast<std::uint32_t>(status)));
  return beltrami_status_name(status) + sizeof "BELTRAMI";
}

std::string row(const std::string& name, const TriangleList& mesh, const std::string& options) {
  const std::vector<Setting> settings = parse(options);
  Hash one, two;
  const std::string at_one = run(mesh, settings, 1, one), at_two = run(mesh, settings, 2, two);
  std::string key = name;
  if (!options.empty()) key += " " + options;
  if (at_one != at_two || one.value() != two.value()) {
    return key + "  two threads differ from one: " + at_one + "  " + one.text() + ", " + at_two +
           "  " + two.text();
  }
  return key + "  " + at_one + "  " + one.text();
}

/// Every way of flattening; on meshes of a few hundred faces with a coarse one of `coarse`.
std::vector<std::string> modes(const std::string& coarse) {
  std::vector<std::string> all = {"method=cm max-iterations=10", "method=tutte"};
  for (const char* words :
       {"", "flatten=dirichlet", "flatten=gif", "flatten=flim", "flatten=bff",
        "energy=symmetric-arap", "energy=symmetric-arap flatten=gif",
        "energy=exponential-dirichlet", "energy=exponential-dirichlet flatten=gif",
        "injectivity=local", "delaunay=on", "refine refine-iterations=2", "float32", "unit-square",
        "method=gif", "method=bff", "method=uv-prolongation"}) {
    all.push_back(*words == 0 ? coarse : coarse + " " + words);
  }
  return all;
}

TriangleList read_bust() {
  std::ifstream file(BELTRAMI_SOURCE_DIR "/examples/data/nefertiti_disk.obj");
  TriangleList mesh;
  for (std::string word; file >> word;) {
    if (word == "v") {
      Vec3 p;
      file >> p.x() >> p.y() >> p.z();
      mesh.positions.push_back(p);
    } else if (word == "f") {
      Triangle t;
      file >> t[0] >> t[1] >> t[2];
      for (Index& v : t) --v;
      mesh.faces.push_back(t);
    } else {
      std::getline(file, word);
    }
  }
  if (mesh.faces.empty()) throw std::runtime_error("cannot read the bust");
  return mesh;
}

/// `f(i)` for a hundred thousand arguments.
std::string function_row(const std::string& name, const std::function<double(disks::Random&)>& f) {
  disks::Random random(1);
  Hash hash;
  for (int i = 0; i < 100000; ++i) hash.add(f(random));
  return name + "  " + hash.text();
}

}  // namespace

std::vector<std::string> function_rows() {
  using disks::Random;
  return {
      function_row("exp", [](Random& r) { return portable::exp(r.between(-750, 715)); }),
      function_row("log",
                   [](Random& r) {
                     const int exponent = r.below(200);
                     return portable::log(std::ldexp(r.unit(), exponent));
                   }),
      function_row("sin", [](Random& r) { return portable::sin(r.between(-1e3, 1e7)); }),
      function_row("cos", [](Random& r) { return portable::cos(r.between(-1e3, 1e7)); }),
      function_row("atan2",
                   [](Random& r) {
                     const Vec2 p = r.vec2();
                     return portable::atan2(p.y(), p.x());
                   }),
      function_row("hypot",
                   [](Random& r) {
                     const Vec2 q = r.vec2();
                     const Vec2 p = std::ldexp(1, r.below(1600) - 800) * q;
                     return portable::hypot(p.x(), p.y());
                   }),
  };
}

std::vector<std::string> small_rows() {
  const std::vector<std::pair<std::string, TriangleList>> models = {
      {"fan", meshes::fan(5)},           {"bumps", meshes::bumps(20, 20)},
      {"cap", meshes::cap(16, 30, 2.6)}, {"ramp", disks::ramp(50, 5)},
      {"dumbbell", disks::dumbbell(9)},  {"slivers", disks::slivers(16, 16)},
      {"tube", disks::tube(20, 8, 1)},   {"degenerate", disks::degenerate_faces(10)},
      {"slit", disks::slit(6)},          {"punctured", disks::punctured(3)}};
  std::vector<std::string> rows;
  for (const auto& [name, mesh] : models) {
    for (const std::string& options : modes("coarse-faces=150")) {
      rows.push_back(row(name, mesh, options));
    }
  }
  // In levels.
  const TriangleList large = meshes::bumps(230, 230);
  for (const char* options :
       {"", "energy=symmetric-arap", "energy=exponential-dirichlet", "float32"}) {
    rows.push_back(row("large bumps", large, options));
  }
  rows.push_back(row("large ramp", disks::ramp(760, 72), ""));
  return rows;
}

std::vector<std::string> bust_rows() {
  const TriangleList bust = read_bust();
  std::vector<std::string> rows = {row("bust", bust, "")};
  for (const std::string& options : modes("coarse-faces=1000")) {
    if (options.find("cm") == std::string::npos) rows.push_back(row("bust", bust, options));
  }
  return rows;
}

std::vector<std::string> random_rows() {
  std::vector<std::string> rows;
  Hash all;
  constexpr int kDisks = 500, kBlock = 100;
  for (int block = 0; block < kDisks; block += kBlock) {
    Hash hash;
    for (int seed = block; seed < block + kBlock; ++seed) {
      const ChartOptions options = disks::random_options(seed);
      const std::string outcome =
          run(disks::random_disk(seed),
              {{BELTRAMI_OPTION_COARSE_FACES, options.coarse_faces},
               {BELTRAMI_OPTION_FLATTEN, static_cast<std::int64_t>(options.flatten)},
               {BELTRAMI_OPTION_ENERGY, static_cast<std::int64_t>(options.energy)},
               {BELTRAMI_OPTION_DELAUNAY, options.delaunay},
               {BELTRAMI_OPTION_UNIT_SQUARE, options.unit_square}},
              1 + seed % 2, hash);
      // No hash may be written of a map that breaks the promise.
      if (outcome.find("  0+0+0  ") == std::string::npos ||
          outcome.find("nan") != std::string::npos)
        throw std::runtime_error("random disk " + std::to_string(seed) + ": " + outcome);
    }
    all.add(hash.value());
    rows.push_back("disks " + std::to_string(block) + " to " + std::to_string(block + kBlock - 1) +
                   "  " + hash.text());
  }
  rows.push_back("all " + std::to_string(kDisks) + "  " + all.text());
  return rows;
}

}  // namespace beltrami::hashes
