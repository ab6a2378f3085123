# How every target of the project is built, and etendue_library(), which makes one from the sources of a folder.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

find_program(ETENDUE_CCACHE ccache)
if(ETENDUE_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${ETENDUE_CCACHE})
endif()

add_library(etendue_flags INTERFACE)
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  target_compile_options(etendue_flags INTERFACE -Wall -Wextra -Wpedantic $<$<BOOL:${ETENDUE_WERROR}>:-Werror>)
  # Bit-for-bit the same results from both compilers: no fused multiply-add that the source does not ask for.
  target_compile_options(etendue_flags INTERFACE -ffp-contract=off)
endif()
# A program loads the shared libraries that it uses, not all that its targets name: of 268, most tests use ten, and each test is a program's
# start. (Debian's GCC does so by itself.)
if(UNIX AND NOT APPLE)
  target_link_options(etendue_flags INTERFACE LINKER:--as-needed)
endif()
# GCC 12 reports overlapping copies inside std::string operators (GCC bug 105651) and unset members of a std::variant's other
# alternative (GCC bug 80635) that cannot happen; clang and the sanitizers check the same.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(etendue_flags INTERFACE -Wno-restrict -Wno-maybe-uninitialized)
endif()
if(ETENDUE_SANITISE)
  target_compile_options(etendue_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(etendue_flags INTERFACE -fsanitize=address,undefined)
endif()
# Coverage for the fuzz targets, in every library.
if(ETENDUE_FUZZ AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  target_compile_options(etendue_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

# etendue_library(NAME LINK targets...): a static library from the *.cpp of the current folder; a new file needs no edit here.
function(etendue_library name)
  cmake_parse_arguments(ARG "" "" "LINK;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  if(NOT sources)
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE ${ARG_LINK})
    return()
  endif()
  add_library(${name} STATIC ${sources})
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_link_libraries(${name} PUBLIC ${ARG_LINK} PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:etendue_flags>)
endfunction()
