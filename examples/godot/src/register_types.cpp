// Makes the class known to Godot.
#include <gdextension_interface.h>

#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/godot.hpp>

#include "beltrami_unwrapper.h"

namespace {

void initialize(godot::ModuleInitializationLevel level) {
  if (level != godot::MODULE_INITIALIZATION_LEVEL_SCENE) return;
  GDREGISTER_CLASS(beltrami_godot::BeltramiUnwrapper);
}

void uninitialize(godot::ModuleInitializationLevel) {}

}  // namespace

extern "C" GDExtensionBool GDE_EXPORT
beltrami_godot_init(GDExtensionInterfaceGetProcAddress get_proc_address,
                    GDExtensionClassLibraryPtr library, GDExtensionInitialization* init) {
  const godot::GDExtensionBinding::InitObject object(get_proc_address, library, init);
  object.register_initializer(initialize);
  object.register_terminator(uninitialize);
  object.set_minimum_library_initialization_level(godot::MODULE_INITIALIZATION_LEVEL_SCENE);
  return object.init();
}
