import os

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.build import check_min_cppstd, stdcpp_library
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, get, rmdir
from conan.tools.microsoft import is_msvc

required_conan_version = ">=2.1"


class BeltramiConan(ConanFile):
    name = "beltrami"
    description = "Injective, low-distortion flattening of disk-like triangle meshes, behind a C ABI"
    license = "Apache-2.0"
    url = "https://github.com/conan-io/conan-center-index"
    homepage = "https://github.com/beltrami/beltrami"
    topics = ("uv-mapping", "mesh-parameterization", "geometry-processing", "texturing")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False]}
    default_options = {"shared": False, "fPIC": True}
    implements = ["auto_shared_fpic"]

    def configure(self):
        # The interface is C.
        if self.options.shared:
            self.options.rm_safe("fPIC")

    def layout(self):
        cmake_layout(self, src_folder="src")

    def requirements(self):
        self.requires("cgal/5.6.1")
        self.requires("eigen/3.4.0")

    def validate(self):
        check_min_cppstd(self, 20)
        if is_msvc(self):
            raise ConanInvalidConfiguration("Microsoft's compiler has not been tried: build with Clang")

    def build_requirements(self):
        self.tool_requires("cmake/[>=3.22 <4]")

    def source(self):
        get(self, **self.conan_data["sources"][self.version], strip_root=True)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["BELTRAMI_EXACT"] = "cgal"
        toolchain.cache_variables["BELTRAMI_BUILD_STATIC"] = False
        toolchain.cache_variables["BELTRAMI_BUILD_PROGRAM"] = False
        toolchain.cache_variables["BELTRAMI_BUILD_TESTS"] = False
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        licenses = os.path.join(self.package_folder, "licenses")
        copy(self, "LICENSE", self.source_folder, licenses)
        copy(self, "*", os.path.join(self.source_folder, "licenses"), licenses)
        CMake(self).install()
        rmdir(self, os.path.join(self.package_folder, "lib", "cmake"))
        rmdir(self, os.path.join(self.package_folder, "lib", "pkgconfig"))
        rmdir(self, os.path.join(self.package_folder, "share"))

    def package_info(self):
        self.cpp_info.libs = ["beltrami"]
        self.cpp_info.set_property("cmake_file_name", "beltrami")
        self.cpp_info.set_property("cmake_target_name", "beltrami::beltrami")
        self.cpp_info.set_property("pkg_config_name", "beltrami")
        if self.options.shared:
            if self.settings.os == "Windows":
                self.cpp_info.defines = ["BELTRAMI_SHARED"]
            return
        # Programs in C link the C++ library of the profile, whichever that is.
        runtime = stdcpp_library(self)
        if runtime:
            self.cpp_info.system_libs.append(runtime)
        if self.settings.os in ("Linux", "FreeBSD"):
            self.cpp_info.system_libs += ["m", "pthread"]
