// A class of Godot that gives meshes UVs.
#pragma once

#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/ref_counted.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/string.hpp>

namespace beltrami_godot {

/// Unwraps the surfaces of a mesh onto common pages. Of one thread at a time.
class BeltramiUnwrapper : public godot::RefCounted {
  GDCLASS(BeltramiUnwrapper, godot::RefCounted)

 public:
  enum Channel { UV = 0, UV2 = 1 };

  /// A copy of a mesh with UVs in a channel, vertices split along the seams; null where there is
  /// none, and `get_error` says why. `options` has those of docs/options.md by their names:
  /// {"target-energy": 2.1, "effort": "quick"}. Blend shapes are not kept.
  godot::Ref<godot::ArrayMesh> unwrap(const godot::Ref<godot::ArrayMesh>& mesh, int channel,
                                      const godot::Dictionary& options);

  /// Whether the UVs of the last mesh are proven to be injective.
  bool is_injective() const { return injective_; }
  /// What the last call failed by, or an empty text.
  godot::String get_error() const { return error_; }

 protected:
  static void _bind_methods();

 private:
  godot::Ref<godot::ArrayMesh> fail(const godot::String& why);

  bool injective_ = false;
  godot::String error_;
};

}  // namespace beltrami_godot

VARIANT_ENUM_CAST(beltrami_godot::BeltramiUnwrapper::Channel);
