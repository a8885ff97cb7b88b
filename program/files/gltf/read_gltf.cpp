// Triangles out of a document.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "files/column.h"
#include "files/gltf/accessor.h"
#include "files/gltf/document.h"
#include "files/gltf/item.h"
#include "files/gltf/materials.h"
#include "files/gltf/model.h"
#include "files/gltf/transforms.h"
#include "files/gltf_file.h"
#include "files/inside_folder.h"
#include "files/mesh_file.h"
#include "files/polygons.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace gltf {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t kTriangles = 4, kFan = 6;  // 5 is a strip
/// Corners of triangles, and vertices of sets, for each byte of the file. The indices of a strip
/// give 3, each once; more are of primitives that share them, which no exporter does many times,
/// while a short file could ask for any amount of memory so.
constexpr std::uint64_t kMostPerByte = 16;
/// Bytes of attributes and morph targets likewise; more, since those of sparse ones are not stored.
constexpr std::uint64_t kMostBytesPerByte = 128;

/// Three vertices per triangle, in the orientation that glTF gives it.
std::vector<std::uint32_t> triangles_of(const Item& primitive, std::uint64_t mode,
                                        std::vector<std::uint32_t> indices) {
  if (mode == kTriangles) {
    if (indices.size() % 3 != 0) {
      primitive.fail("its " + std::to_string(indices.size()) +
                     " corners are no whole triangles: export the file again");
    }
    return indices;
  }
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i + 2 < indices.size(); ++i) {
    std::array<std::uint32_t, 3> triangle = {indices[i], indices[i + 1 + i % 2],
                                             indices[i + 2 - i % 2]};
    if (mode == kFan) triangle = {indices[i + 1], indices[i + 2], indices[0]};
    const auto [a, b, c] = triangle;
    if (a == b || b == c || c == a) continue;  // joins the parts of a strip
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  return corners;
}

/// A primitive with the vertices of its set.
struct Local {
  std::uint32_t primitive = 0, set = 0;
  std::vector<std::uint32_t> corners;
};

class Reader {
 public:
  Reader(MeshFile& file, Model& model, std::uint64_t bytes)
      : document_(model.document), file_(file), model_(model), bytes_(bytes) {}

  void read(bool attributes) {
    const std::vector<std::optional<Transform>> transforms = mesh_transforms(document_);
    for (std::uint32_t mesh = 0; mesh < transforms.size(); ++mesh) {
      throw_if_interrupted();
      read_mesh(mesh, transforms[mesh]);
    }
    if (corners_.empty()) document_.root().fail("there are no triangles in it");
    file_.polygons = Polygons(std::move(corners_));
    if (attributes) add_face_columns();
  }

 private:
  void read_mesh(std::uint32_t mesh, const std::optional<Transform>& transform) {
    const Item item = document_.entry("meshes", mesh);
    const std::optional<Item> list = item.array("primitives");
    if (!list) item.fail("it has no primitives");
    std::vector<Local> primitives;
    for (std::uint32_t i = 0; i < list->size(); ++i)
      read_primitive((*list)[i], mesh, i, primitives);
    // Those of the same set have vertices in common.
    std::map<std::uint32_t, std::vector<std::uint32_t>> used;
    for (const Local& local : primitives) {
      std::vector<std::uint32_t>& vertices = used[local.set];
      for (const std::uint32_t vertex : local.corners) {
        std::uint32_t& number = number_of_[local.set][vertex];
        if (number != kNoVertex) continue;
        number = 0;
        vertices.push_back(vertex);
      }
    }
    for (auto& [set, vertices] : used) {
      std::sort(vertices.begin(), vertices.end());
      add_vertices(set, vertices, transform);
    }
    for (const Local& local : primitives) add_primitive(mesh, local);
    for (const auto& [set, vertices] : used) {
      for (const std::uint32_t vertex : vertices) number_of_[set][vertex] = kNoVertex;
    }
  }

  void read_primitive(const Item& item, std::uint32_t mesh, std::uint32_t number,
                      std::vector<Local>& primitives) {
    const std::uint64_t mode = item.whole("mode", kTriangles);
    if (mode > kFan) item.fail("mode " + std::to_string(mode) + " is none of glTF 2.0");
    if (mode < kTriangles) return;
    const std::optional<Item> attributes = item.object("attributes");
    if (!attributes) item.fail("it has no attributes");
    if (!attributes->find("POSITION")) return;  // is not drawn
    Local local{number, set_of(item, *attributes, mesh, number), {}};
    const std::uint64_t count = model_.sets[local.set].count;
    std::vector<std::uint32_t> indices;
    if (const std::optional<std::uint64_t> accessor = item.whole("indices")) {
      indices = indices_of(document_, *accessor);
      if (*std::max_element(indices.begin(), indices.end()) >= count) {
        item.fail("an index is not below the " + std::to_string(count) +
                  " vertices: the file is damaged, export it again");
      }
    } else {
      indices.resize(count);
      std::iota(indices.begin(), indices.end(), 0u);
    }
    local.corners = triangles_of(item, mode, std::move(indices));
    of_primitives_ += local.corners.size();
    require_in_proportion(item, of_primitives_, kMostPerByte);
    primitives.push_back(std::move(local));
  }

  std::uint32_t set_of(const Item& item, const Item& attributes, std::uint32_t mesh,
                       std::uint32_t number) {
    const std::optional<Item> targets = item.array("targets");
    const std::string key = attributes.json.dump() + (targets ? targets->json.dump() : "");
    const auto [found, is_new] =
        numbers_of_sets_.try_emplace(key, static_cast<std::uint32_t>(model_.sets.size()));
    if (!is_new) return found->second;
    const Accessor positions = positions_of(attributes);
    require_whole(attributes, positions.count());
    for (std::uint64_t i = 0; targets && i < targets->size(); ++i) {
      require_whole((*targets)[i], positions.count());
    }
    of_sets_ += positions.count();
    require_in_proportion(item, of_sets_, kMostPerByte);
    model_.sets.push_back({mesh, number, positions.count()});
    number_of_.emplace_back(positions.count(), kNoVertex);
    return found->second;
  }

  Accessor positions_of(const Item& attributes) const {
    const std::uint64_t number = attributes.required("POSITION");
    Accessor positions(document_, number);
    if (positions.type() != "VEC3" || positions.component() == Component::kU32) {
      document_.entry("accessors", number).fail("positions are no vectors that glTF allows");
    }
    if (positions.count() > static_cast<std::uint64_t>(kMaxIndex)) too_many();
    return positions;
  }

  /// What the writer is going to rely on.
  void require_whole(const Item& attributes, std::uint64_t count) {
    if (!attributes.json.is_object()) attributes.fail("it is no object");
    for (const auto& [name, unused] : attributes.json.items()) {
      const std::uint64_t number = attributes.required(name.c_str());
      const Accessor accessor(document_, number, count);
      of_attributes_ += count * accessor.element_size();
      require_in_proportion(attributes, of_attributes_, kMostBytesPerByte);
      if (name.starts_with("TEXCOORD_") && accessor.type() != "VEC2") {
        document_.entry("accessors", number).fail("UVs are no pairs");
      }
      if (name == "POSITION" && accessor.type() != "VEC3") {
        document_.entry("accessors", number).fail("the positions of a morph target are no vectors");
      }
    }
  }

  void add_vertices(std::uint32_t set, const std::vector<std::uint32_t>& vertices,
                    const std::optional<Transform>& transform) {
    const VertexSet& owner = model_.sets[set];
    const Item primitive = model_.primitive(owner.mesh, owner.primitive);
    const Accessor positions = positions_of(*primitive.object("attributes"));
    if (model_.local.size() + vertices.size() > static_cast<std::uint64_t>(kMaxIndex)) too_many();
    for (const std::uint32_t vertex : vertices) {
      number_of_[set][vertex] = static_cast<std::uint32_t>(model_.local.size());
      model_.local.push_back(vertex);
      std::array<double, 3> p{};
      for (std::size_t k = 0; k < 3; ++k) p[k] = positions.value(vertex, k);
      if (transform) p = image_of(*transform, p);
      file_.positions.insert(file_.positions.end(), p.begin(), p.end());
    }
  }

  void add_primitive(std::uint32_t mesh, const Local& local) {
    const std::uint64_t first = corners_.size() / 3, faces = local.corners.size() / 3;
    if (first + faces > static_cast<std::uint64_t>(kMaxIndex)) too_many();
    model_.primitives.push_back(
        {mesh, local.primitive, local.set, first, faces,
         sets_of_normal_maps(document_, model_.primitive(mesh, local.primitive))});
    for (const std::uint32_t vertex : local.corners) {
      corners_.push_back(number_of_[local.set][vertex]);
    }
  }

  void add_face_columns() {
    Column mesh("mesh", Scalar::kI32), number("primitive", Scalar::kI32);
    Column material("material", Scalar::kI32);
    for (const Primitive& primitive : model_.primitives) {
      const std::optional<std::uint64_t> of_primitive =
          model_.primitive(primitive.mesh, primitive.primitive).whole("material");
      for (std::uint64_t i = 0; i < primitive.face_count; ++i) {
        mesh.append(primitive.mesh);
        number.append(primitive.primitive);
        material.append(of_primitive ? static_cast<double>(*of_primitive) : -1);
      }
    }
    file_.face_columns = {std::move(mesh), std::move(number), std::move(material)};
  }

  void require_in_proportion(const Item& item, std::uint64_t items, std::uint64_t per_byte) const {
    if (items <= per_byte * bytes_) return;
    item.fail("up to here the primitives have more than " + std::to_string(per_byte) +
              " items for each byte of the file, which they share: split the file, or export it "
              "again");
  }

  [[noreturn]] void too_many() const {
    document_.root().fail("there are more than " + std::to_string(kMaxIndex) +
                          " vertices or triangles: split the file");
  }

  const Document& document_;
  MeshFile& file_;
  Model& model_;
  std::uint64_t bytes_;                                   ///< of the file and its buffers
  std::uint64_t of_sets_ = 0, of_primitives_ = 0;         ///< vertices, corners
  std::uint64_t of_attributes_ = 0;                       ///< bytes
  std::vector<std::uint32_t> corners_;                    ///< of the polygons
  std::map<std::string, std::uint32_t> numbers_of_sets_;  ///< by attributes and targets as text
  /// Per set and vertex: which vertex of the file it is in the mesh at hand.
  std::vector<std::vector<std::uint32_t>> number_of_;
};

}  // namespace
}  // namespace gltf

MeshFile read_gltf(std::string_view bytes, const std::string& path, Content content, Reach reach) {
  const auto model = std::make_shared<gltf::Model>();
  model->document = gltf::read_document(bytes, path, reach);
  MeshFile file;
  std::uint64_t size = bytes.size();
  for (const std::string& buffer : model->document.buffers) size += buffer.size();
  gltf::Reader(file, *model, size).read(wants_attributes(content));
  file.not_kept = model->document.not_kept;
  file.gltf = model;
  if (content == Content::kSurface) return file;
  for (const gltf::Primitive& place : model->primitives) {
    const gltf::Item primitive = model->primitive(place.mesh, place.primitive);
    if (!primitive.object("attributes")->find("TEXCOORD_0")) {
      primitive.fail("it has no texture coordinates, TEXCOORD_0");
    }
  }
  file.uvs = gltf_uvs(file, 0);
  return file;
}

std::vector<double> gltf_attribute(const MeshFile& file, const char* name, std::size_t width) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const gltf::Model& model = gltf::model_of(file);
  std::vector<double> values(width * file.vertex_count(), kNone);
  bool any = false;
  for (const gltf::Primitive& primitive : model.primitives) {
    const gltf::Item item = model.primitive(primitive.mesh, primitive.primitive);
    const std::optional<std::uint64_t> number = item.object("attributes")->whole(name);
    if (!number) continue;
    const gltf::Accessor accessor(model.document, *number, model.sets[primitive.set].count);
    if (accessor.type() != "VEC" + std::to_string(width)) continue;
    any = true;
    const std::uint64_t first = 3 * primitive.first_face;
    for (std::uint64_t c = first; c < first + 3 * primitive.face_count; ++c) {
      const std::uint32_t vertex = file.polygons.corners()[c];
      for (std::size_t k = 0; k < width; ++k) {
        values[width * vertex + k] = accessor.value(model.local[vertex], k);
      }
    }
  }
  if (!any) values.clear();
  return values;
}

std::vector<double> gltf_uvs(const MeshFile& file, std::uint32_t uv_set) {
  const std::string name = "TEXCOORD_" + std::to_string(uv_set);
  std::vector<double> uvs = gltf_attribute(file, name.c_str(), 2);
  for (std::size_t i = 1; i < uvs.size(); i += 2) uvs[i] = 1 - uvs[i];
  return uvs;
}

std::vector<bool> gltf_faces_of(const MeshFile& file, std::uint64_t material) {
  const gltf::Model& model = gltf::model_of(file);
  std::vector<bool> found(file.polygons.size(), false);
  for (const gltf::Primitive& place : model.primitives) {
    const std::vector<std::uint64_t> own =
        gltf::materials_of(model.primitive(place.mesh, place.primitive));
    if (std::find(own.begin(), own.end(), material) == own.end()) continue;
    std::fill_n(found.begin() + static_cast<std::ptrdiff_t>(place.first_face), place.face_count,
                true);
  }
  return found;
}

}  // namespace beltrami::cli
