# The functions that CMakeLists.txt uses.

# anholon_layer(name [DEPENDS layers...] [LINKS targets...] [PRIVATE_LINKS targets...]
#               [SOURCES generated...] [EXCLUDE file names...] [ALONE file names...] [PRECOMPILED header])
#
# Makes the static library anholon_<name> from src/<name>/**/*.cpp; INTERFACE if there are only headers. Files are
# compiled in batches (ANHOLON_UNITY), except the files of ALONE, whose local names occur in other files as well. A
# layer without files makes no target; a layer that depends on it links the layers below instead.
function(anholon_layer name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "PRECOMPILED" "DEPENDS;LINKS;PRIVATE_LINKS;SOURCES;EXCLUDE;ALONE")
  set(folder "${PROJECT_SOURCE_DIR}/src/${name}")
  # The folder is globbed even if it is missing: its first file then triggers a new configure.
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${folder}/*.cpp")
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS "${folder}/*.h" "${folder}/*.def")
  list(LENGTH sources found_sources)
  list(LENGTH headers found_headers)
  foreach(excluded IN LISTS arg_EXCLUDE)
    list(REMOVE_ITEM sources "${folder}/${excluded}")
  endforeach()
  list(APPEND sources ${arg_SOURCES})

  set(links "")
  foreach(layer IN LISTS arg_DEPENDS)
    if(TARGET anholon_${layer})
      list(APPEND links anholon_${layer})
    else()
      get_property(instead GLOBAL PROPERTY ANHOLON_LINKS_OF_${layer})
      list(APPEND links ${instead})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES links)
  set_property(GLOBAL PROPERTY ANHOLON_LINKS_OF_${name} "${links}")
  if(found_sources EQUAL 0 AND found_headers EQUAL 0)
    return()
  endif()

  if(sources)
    add_library(anholon_${name} STATIC ${sources})
    target_link_libraries(anholon_${name}
      PUBLIC anholon_options ${links} ${arg_LINKS} PRIVATE anholon_warnings ${arg_PRIVATE_LINKS})
    if(NOT arg_PRECOMPILED)
      set(arg_PRECOMPILED mechanics)
    endif()
    anholon_use_precompiled(anholon_${name} ${arg_PRECOMPILED})
    anholon_in_batches(anholon_${name})
    list(TRANSFORM arg_ALONE PREPEND "${folder}/")
    # A generated file is compiled alone as well, since a test may replace it.
    set_source_files_properties(${arg_ALONE} ${arg_SOURCES} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  else()
    add_library(anholon_${name} INTERFACE)
    target_link_libraries(anholon_${name} INTERFACE anholon_options ${links} ${arg_LINKS})
  endif()
  if(name STREQUAL "cli" AND sources)
    anholon_cli_definitions(anholon_cli)
  endif()
  set_property(GLOBAL APPEND PROPERTY ANHOLON_LAYERS ${name})
endfunction()

# anholon_precompiled(name [HEADER name] [LINKS targets...] [OPTIONS flags...])
#
# Compiles cmake/precompiled/<header>.h once, with these flags; anholon_use_precompiled gives a target both. Without
# ANHOLON_PCH every file is compiled by itself, which shows the includes that it lacks.
function(anholon_precompiled name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "HEADER" "LINKS;OPTIONS")
  set_property(GLOBAL PROPERTY ANHOLON_OPTIONS_OF_${name} "${arg_OPTIONS}")
  if(NOT arg_HEADER)
    set(arg_HEADER ${name})
  endif()
  if(ANHOLON_PCH)
    set(source "${CMAKE_BINARY_DIR}/generated/precompiled_${name}.cpp")
    file(CONFIGURE OUTPUT "${source}" CONTENT "// Empty: the precompiled header of this target counts.\n")
    add_library(anholon_precompiled_${name} OBJECT "${source}")
    target_include_directories(anholon_precompiled_${name} PRIVATE "${PROJECT_SOURCE_DIR}")
    target_compile_options(anholon_precompiled_${name} PRIVATE ${arg_OPTIONS})
    target_link_libraries(anholon_precompiled_${name} PRIVATE anholon_options anholon_warnings ${arg_LINKS})
    target_precompile_headers(anholon_precompiled_${name} PRIVATE "${PROJECT_SOURCE_DIR}/cmake/precompiled/${arg_HEADER}.h")
  endif()
endfunction()

function(anholon_use_precompiled target name)
  get_property(options GLOBAL PROPERTY ANHOLON_OPTIONS_OF_${name})
  target_compile_options(${target} PRIVATE ${options})
  if(ANHOLON_PCH)
    target_precompile_headers(${target} REUSE_FROM anholon_precompiled_${name})
    # ccache needs this option.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  endif()
endfunction()

# Compiles the files of a target in batches, which takes half of the time. Without ANHOLON_UNITY every file is compiled
# by itself, which is better for work on one file.
function(anholon_in_batches target)
  if(ANHOLON_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()

# There is one file per instruction set, among which the program chooses at run time. They are optimized in every
# build, as they are not meant for a debugger.
function(anholon_kernel_tiers)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(folder "${PROJECT_SOURCE_DIR}/src/kernel/tiers")
    set_source_files_properties("${folder}/tier_plain.cpp" PROPERTIES COMPILE_OPTIONS "-O2")
    # The flags differ from those of the precompiled header.
    set_source_files_properties("${folder}/tier_plain.cpp" "${folder}/tier_avx2.cpp" "${folder}/tier_avx512.cpp" PROPERTIES
      SKIP_PRECOMPILE_HEADERS ON)
    set_source_files_properties("${folder}/tier_avx2.cpp" PROPERTIES COMPILE_OPTIONS "-O2;-mavx2;-mfma")
    set_source_files_properties("${folder}/tier_avx512.cpp" PROPERTIES COMPILE_OPTIONS "-O2;-mavx2;-mfma;-mavx512f;-mprefer-vector-width=512")
  endif()
endfunction()

# src/jit: a module of its own, which the program loads when it needs machine code, so that LLVM costs nothing before.
# It includes headers of the kernel only. It is left out if LLVM is not installed; everything works without it.
function(anholon_compiler_module)
  # Program and module share the types of these headers. A hash of the headers shows the program whether the module
  # beside it belongs to another build.
  set(layout "")
  foreach(header kernel/arithmetic kernel/code kernel/plan/plan program/sparse_lu)
    set(file "${PROJECT_SOURCE_DIR}/src/${header}.h")
    file(SHA256 "${file}" hash)
    string(APPEND layout "${hash}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
  endforeach()
  string(SHA256 layout "${layout}")
  set(layout "ANHOLON_KERNEL_LAYOUT=\"${layout}\"")
  set_source_files_properties("${PROJECT_SOURCE_DIR}/src/kernel/compiler.cpp" PROPERTIES COMPILE_DEFINITIONS "${layout}")
  if(NOT ANHOLON_JIT)
    return()
  endif()
  find_package(LLVM 19.1 QUIET CONFIG)
  if(NOT LLVM_FOUND)
    message(STATUS "LLVM 19 was not found: kernels are not compiled")
    return()
  endif()
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/jit/*.cpp" "${PROJECT_SOURCE_DIR}/src/jit/x86/*.cpp")
  anholon_precompiled(compiler LINKS LLVM)
  if(TARGET anholon_precompiled_compiler)
    target_include_directories(anholon_precompiled_compiler SYSTEM PRIVATE ${LLVM_INCLUDE_DIRS})
  endif()
  add_library(anholon_jit MODULE ${sources})
  set_target_properties(anholon_jit PROPERTIES PREFIX "" OUTPUT_NAME "anholon-compiler" LIBRARY_OUTPUT_DIRECTORY "${ANHOLON_PROGRAM_DIR}"
    CXX_VISIBILITY_PRESET hidden)
  target_compile_options(anholon_jit PRIVATE -ffp-contract=off)
  target_compile_definitions(anholon_jit PRIVATE "${layout}")
  target_include_directories(anholon_jit PRIVATE "${PROJECT_SOURCE_DIR}/src")
  target_include_directories(anholon_jit SYSTEM PRIVATE ${LLVM_INCLUDE_DIRS})
  # The needed parts of LLVM are linked from archives: the shared library of all of LLVM takes several times longer to
  # load, and would meet other copies in processes that load this module.
  llvm_map_components_to_libnames(llvm orcjit scalaropts x86codegen x86desc x86info)
  target_link_libraries(anholon_jit PRIVATE ${llvm} anholon_options anholon_warnings)
  # The linker is ld itself, which packs the relocations of LLVM's tables: they are a twentieth of the file.
  target_link_options(anholon_jit PRIVATE -Wl,--exclude-libs,ALL -Wl,--gc-sections
    -Wl,-z,pack-relative-relocs -Wl,-z,defs)
  target_link_libraries(anholon_jit PRIVATE -fuse-ld=bfd)  # follows the name of the other linker
  anholon_use_precompiled(anholon_jit compiler)
  anholon_in_batches(anholon_jit)
  # The id of the build is part of the key of code that is kept on disk.
  target_link_options(anholon_jit PRIVATE -Wl,--build-id=sha1)
  install(TARGETS anholon_jit LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/anholon" COMPONENT program)
endfunction()

# libanholon: the layers behind the headers of include/anholon, as one shared library that other projects find by
# find_package(anholon) and link as anholon::anholon. The program links the layers themselves.
function(anholon_public_library)
  if(NOT TARGET anholon_api)
    return()
  endif()
  file(GLOB headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/anholon/*.h")
  add_library(anholon_library SHARED $<TARGET_OBJECTS:anholon_api>)
  add_library(anholon::anholon ALIAS anholon_library)
  set_target_properties(anholon_library PROPERTIES OUTPUT_NAME anholon EXPORT_NAME anholon
    VERSION "${PROJECT_VERSION}" SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
  target_sources(anholon_library PUBLIC FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}/include" FILES ${headers})
  target_compile_features(anholon_library INTERFACE cxx_std_20)
  get_target_property(links anholon_api LINK_LIBRARIES)
  target_link_libraries(anholon_library PRIVATE ${links})
  target_link_options(anholon_library PRIVATE -Wl,--exclude-libs,ALL)
  include(CMakePackageConfigHelpers)
  set(place "${CMAKE_INSTALL_LIBDIR}/cmake/anholon")
  install(TARGETS anholon_library EXPORT anholonConfig
    LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(EXPORT anholonConfig NAMESPACE anholon:: DESTINATION "${place}")
  write_basic_package_version_file("${CMAKE_BINARY_DIR}/anholonConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
  install(FILES "${CMAKE_BINARY_DIR}/anholonConfigVersion.cmake" DESTINATION "${place}")
endfunction()

# Installs the licence of Anholon, and those of the linked libraries if the build takes them from
# tools/static_libraries.py.
function(anholon_install_licences place component)
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${place}" COMPONENT "${component}" RENAME anholon.txt)
  install(FILES "${PROJECT_SOURCE_DIR}/viewer/dist/licences.txt" DESTINATION "${place}" COMPONENT "${component}" RENAME viewer.txt OPTIONAL)
  set(prefixes ${CMAKE_PREFIX_PATH})
  string(REPLACE ":" ";" more "$ENV{CMAKE_PREFIX_PATH}")
  foreach(prefix IN LISTS prefixes more)
    if(IS_DIRECTORY "${prefix}/licences")
      install(DIRECTORY "${prefix}/licences/" DESTINATION "${place}" COMPONENT "${component}")
    endif()
  endforeach()
endfunction()

# Only this function and modelfile/text/shipped.cpp define the source folder, so that ccache can serve the other files
# to a second checkout.
function(anholon_cli_definitions target)
  # The types of the public headers stay in their namespace, as types of the layers have the same names.
  target_compile_definitions(${target} PRIVATE ANHOLON_LIBRARY
    ANHOLON_PAPERS_DIR="${PROJECT_SOURCE_DIR}/papers"
    ANHOLON_VERSION="${PROJECT_VERSION}")
endfunction()

# Links every existing layer below cli.
function(anholon_link_layers target)
  get_property(layers GLOBAL PROPERTY ANHOLON_LAYERS)
  list(REMOVE_ITEM layers cli)
  list(TRANSFORM layers PREPEND anholon_)
  target_link_libraries(${target} PRIVATE anholon_options ${layers})
endfunction()

# A formulation is found by its file name: src/formulation/forms/<unknowns>/<name>.cpp defines `extern const
# Formulation <name>;` in namespace anholon::forms. Linking by name (and not by self-registration) keeps the linker
# from dropping one silently. With EXTRA, further files, the registry needs a NAME of its own: a test adds a form in
# this way.
function(anholon_formulation_registry result)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "NAME" "EXTRA")
  set(${result} "" PARENT_SCOPE)
  file(GLOB_RECURSE forms CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/formulation/forms/*.cpp")
  file(GLOB header CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/formulation/formulation.h")
  if(NOT header)
    return()
  endif()
  list(APPEND forms ${arg_EXTRA})
  list(TRANSFORM forms REPLACE ".*/([^/]+)\\.cpp$" "\\1")
  list(SORT forms)
  set(declarations "")
  set(entries "")
  foreach(form IN LISTS forms)
    if(NOT form MATCHES "^[a-z][a-z0-9_]*$")
      message(FATAL_ERROR "src/formulation/forms: ${form}.cpp: the file name must be the C++ name of its Formulation")
    endif()
    string(APPEND declarations "extern const Formulation ${form};\n")
    string(APPEND entries "      &forms::${form},\n")
  endforeach()
  set(output "${CMAKE_BINARY_DIR}/generated/${arg_NAME}formulation_registry.cpp")
  file(CONFIGURE OUTPUT "${output}" @ONLY CONTENT [=[
// Written by the build from the file names in src/formulation/forms.
#include <vector>

#include "formulation/formulation.h"

namespace anholon::forms {
@declarations@}  // namespace anholon::forms

namespace anholon {
const std::vector<const Formulation*>& formulations();
const std::vector<const Formulation*>& formulations() {
  static const std::vector<const Formulation*> all{
@entries@  };
  return all;
}
}  // namespace anholon
]=])
  set(${result} "${output}" PARENT_SCOPE)
endfunction()

# Debian has no CMake packages of these libraries: makes external::<name> from one header and its libraries.
function(anholon_find_library name header)
  find_path(ANHOLON_${name}_INCLUDE ${header})
  # A folder counts before a name: CMAKE_PREFIX_PATH comes first, whatever name the library has there.
  find_library(ANHOLON_${name}_LIBRARY NAMES ${ARGN} NAMES_PER_DIR)
  mark_as_advanced(ANHOLON_${name}_INCLUDE ANHOLON_${name}_LIBRARY)
  if(NOT ANHOLON_${name}_INCLUDE OR NOT ANHOLON_${name}_LIBRARY)
    message(FATAL_ERROR "${name} not found (<${header}>); ./dev setup installs it")
  endif()
  add_library(external::${name} INTERFACE IMPORTED)
  target_include_directories(external::${name} INTERFACE "${ANHOLON_${name}_INCLUDE}")
  target_link_libraries(external::${name} INTERFACE "${ANHOLON_${name}_LIBRARY}")
endfunction()

function(anholon_find_header name header)
  find_path(ANHOLON_${name}_INCLUDE ${header})
  mark_as_advanced(ANHOLON_${name}_INCLUDE)
  if(NOT ANHOLON_${name}_INCLUDE)
    message(FATAL_ERROR "${name} not found (<${header}>); ./dev setup installs it")
  endif()
  add_library(external::${name} INTERFACE IMPORTED)
  target_include_directories(external::${name} INTERFACE "${ANHOLON_${name}_INCLUDE}")
endfunction()

# An optional library: ANHOLON_FOUND_<name> is external::<name>, which defines ANHOLON_<NAME>. It is empty if `option`
# is off or none of the pkg-config modules is found.
function(anholon_find_optional name option)
  set(ANHOLON_FOUND_${name} "" PARENT_SCOPE)
  if(NOT ${option})
    return()
  endif()
  find_package(PkgConfig QUIET)
  foreach(module IN LISTS ARGN)
    if(PkgConfig_FOUND AND NOT TARGET PkgConfig::ANHOLON_${module})
      pkg_check_modules(ANHOLON_${module} QUIET IMPORTED_TARGET ${module})
    endif()
    if(TARGET PkgConfig::ANHOLON_${module})
      add_library(external::${name} INTERFACE IMPORTED)
      string(TOUPPER "${name}" upper)
      target_compile_definitions(external::${name} INTERFACE ANHOLON_${upper})
      target_link_libraries(external::${name} INTERFACE PkgConfig::ANHOLON_${module})
      set(ANHOLON_FOUND_${name} external::${name} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(STATUS "${name} was not found: the build does without it")
endfunction()

# A library that is found is not linked, but loaded when it is needed, by its name in ANHOLON_<NAME>_FILE.
function(anholon_load_at_run_time name)
  if(NOT ANHOLON_FOUND_${name})
    return()
  endif()
  get_target_property(package external::${name} INTERFACE_LINK_LIBRARIES)
  get_target_property(folders ${package} INTERFACE_INCLUDE_DIRECTORIES)
  get_target_property(libraries ${package} INTERFACE_LINK_LIBRARIES)
  list(GET libraries 0 file)
  execute_process(COMMAND "${CMAKE_OBJDUMP}" -p "${file}" OUTPUT_VARIABLE header ERROR_QUIET)
  if(NOT header MATCHES "SONAME +([^ \n]+)")
    message(FATAL_ERROR "${file} has no SONAME")
  endif()
  string(TOUPPER "${name}" upper)
  set_target_properties(external::${name} PROPERTIES INTERFACE_LINK_LIBRARIES "")
  target_compile_definitions(external::${name} INTERFACE ANHOLON_${upper}_FILE="${CMAKE_MATCH_1}")
  if(folders)
    target_include_directories(external::${name} SYSTEM INTERFACE ${folders})
  endif()
endfunction()

function(anholon_pick_linker target)
  find_program(ANHOLON_MOLD mold)
  find_program(ANHOLON_LLD NAMES ld.lld-19)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND ANHOLON_LLD)
    target_link_options(${target} INTERFACE -fuse-ld=lld)
  elseif(ANHOLON_MOLD)
    target_link_options(${target} INTERFACE -fuse-ld=mold)
  endif()
endfunction()

# src/report: the style of pages, the literature, and the viewer if npm has built it (viewer/dist) are put into the
# program unchanged.
function(anholon_page_assets result)
  set(folder "${PROJECT_SOURCE_DIR}")
  set(nothing "${CMAKE_BINARY_DIR}/generated/nothing")
  file(WRITE "${nothing}" "")
  set(assets "")
  set(functions "")
  set(files "")
  foreach(asset page_style=src/report/page.css viewer_script=viewer/dist/viewer.js viewer_style=viewer/dist/viewer.css
          studio_script=viewer/dist/studio.js studio_style=viewer/dist/studio.css
          map_script=src/report/map.js map_style=src/report/map.css literature=refs.bib)
    string(REGEX MATCH "^([a-z_]+)=(.*)$" asset "${asset}")
    set(name "${CMAKE_MATCH_1}")
    set(file "${folder}/${CMAKE_MATCH_2}")
    if(NOT EXISTS "${file}")
      set(file "${nothing}")
    endif()
    string(APPEND assets "asm(\".section .rodata\\n\"\n    \"anholon_${name}: .incbin \\\"${file}\\\"\\n\"\n    \"anholon_${name}_end: .byte 0\\n\"\n    \".previous\\n\");\nextern \"C\" const char anholon_${name}[], anholon_${name}_end[];\n")
    string(APPEND functions "std::string_view ${name}() { return {anholon_${name}, static_cast<std::size_t>(anholon_${name}_end - anholon_${name})}; }\n")
    list(APPEND files "${file}")
  endforeach()
  set(output "${CMAKE_BINARY_DIR}/generated/page_assets.cpp")
  file(CONFIGURE OUTPUT "${output}" @ONLY CONTENT [=[
// Written by the build: files that the program carries.
#include "report/assets.h"

#include <cstddef>

@assets@
namespace anholon {
@functions@}  // namespace anholon
]=])
  set_source_files_properties("${output}" PROPERTIES OBJECT_DEPENDS "${files}")
  set(${result} "${output}" PARENT_SCOPE)
endfunction()
