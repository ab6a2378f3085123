# What the project needs from outside, each with a message that says what is missing and how Debian calls it.
function(etendue_missing what debian)
  message(FATAL_ERROR "Etendue needs ${what}, which was not found.\n"
    "  Debian, Ubuntu: sudo apt-get install ${debian}   (or all at once: sdk/setup)\n"
    "  elsewhere: README.md, 'What it needs', lists every package")
endfunction()

find_package(Threads REQUIRED)
find_package(PkgConfig QUIET)

find_package(nlohmann_json 3.7 QUIET)
if(NOT nlohmann_json_FOUND)
  etendue_missing("nlohmann-json (>= 3.7)" "nlohmann-json3-dev")
endif()

find_package(fmt QUIET)
if(NOT fmt_FOUND)
  etendue_missing("fmt" "libfmt-dev")
endif()

# Highway: kernels compiled once for each instruction set, the machine's best chosen at run time.
find_package(hwy QUIET)
if(NOT hwy_FOUND)
  etendue_missing("Highway (>= 1.0.3)" "libhwy-dev")
endif()

if(ETENDUE_CORE_ONLY)
  return()
endif()

find_package(CLI11 QUIET)
if(NOT CLI11_FOUND)
  etendue_missing("CLI11" "libcli11-dev")
endif()

find_package(pugixml QUIET)
if(NOT pugixml_FOUND)
  etendue_missing("pugixml" "libpugixml-dev")
endif()

find_package(TinyGLTF QUIET)
if(NOT TinyGLTF_FOUND)
  etendue_missing("tinygltf" "libtinygltf-dev")
endif()

# pkg-config first: Debian's CMake files of Imath insist on a Python library that its package does not bring.
if(PkgConfig_FOUND)
  pkg_check_modules(OpenEXR QUIET IMPORTED_TARGET OpenEXR)
endif()
if(TARGET PkgConfig::OpenEXR)
  add_library(OpenEXR::OpenEXR ALIAS PkgConfig::OpenEXR)
else()
  find_package(OpenEXR 3 QUIET)
  if(NOT OpenEXR_FOUND)
    etendue_missing("OpenEXR (>= 3)" "libopenexr-dev libimath-dev")
  endif()
endif()

find_package(OpenImageIO QUIET)
if(NOT OpenImageIO_FOUND)
  etendue_missing("OpenImageIO (>= 2.4)" "libopenimageio-dev openimageio-tools")
endif()
# Debian's target names OpenCV's headers even where OpenCV is not installed; CMake refuses a path that is not there.
get_target_property(oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
set(oiio_existing)
foreach(path IN LISTS oiio_includes)
  if(path MATCHES "^\\$<" OR EXISTS "${path}")
    list(APPEND oiio_existing "${path}")
  endif()
endforeach()
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${oiio_existing}")

# pkg-config first: Debian's CMake files of OpenColorIO compute a wrong prefix.
if(PkgConfig_FOUND)
  pkg_check_modules(OpenColorIO QUIET IMPORTED_TARGET OpenColorIO)
endif()
if(TARGET PkgConfig::OpenColorIO)
  add_library(OpenColorIO::OpenColorIO ALIAS PkgConfig::OpenColorIO)
else()
  find_package(OpenColorIO 2.1 QUIET CONFIG)
  if(NOT TARGET OpenColorIO::OpenColorIO)
    etendue_missing("OpenColorIO (>= 2.1)" "libopencolorio-dev")
  endif()
endif()

# Embree 4 and 3 differ in their header's folder and in a few calls; both are supported.
find_package(embree 4 QUIET)
if(embree_FOUND)
  set(ETENDUE_EMBREE_MAJOR 4)
else()
  find_package(embree 3 QUIET)
  set(ETENDUE_EMBREE_MAJOR 3)
endif()
if(NOT embree_FOUND)
  etendue_missing("Embree (3 or 4)" "libembree-dev")
endif()

# Optional: without them compressed meshes of glTF are not decoded.
find_package(draco QUIET)
find_package(meshoptimizer QUIET)

if(ETENDUE_TESTS)
  find_package(GTest QUIET)
  if(NOT GTest_FOUND)
    etendue_missing("GoogleTest" "libgtest-dev")
  endif()
endif()
