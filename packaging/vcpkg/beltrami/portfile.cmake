vcpkg_from_github(
    OUT_SOURCE_PATH SOURCE_PATH
    REPO beltrami/beltrami
    REF "v${VERSION}"
    SHA512 0 # of the release's archive
    HEAD_REF main
)

set(solver native)
if("cholmod" IN_LIST FEATURES)
    set(solver cholmod)
endif()

# BUILD_SHARED_LIBS follows the triplet's linkage.
vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS
        -DBELTRAMI_SOLVER=${solver}
        -DBELTRAMI_EXACT=cgal
        -DBELTRAMI_BUILD_STATIC=OFF
        -DBELTRAMI_BUILD_PROGRAM=OFF
        -DBELTRAMI_BUILD_TESTS=OFF
)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/beltrami)
vcpkg_fixup_pkgconfig()

file(REMOVE_RECURSE
    "${CURRENT_PACKAGES_DIR}/debug/include"
    "${CURRENT_PACKAGES_DIR}/debug/share"
    "${CURRENT_PACKAGES_DIR}/share/doc"
)
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE" "${SOURCE_PATH}/licenses/THIRD-PARTY.txt")
