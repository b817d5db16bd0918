# The Python module. In a build tree it lies in ${CMAKE_BINARY_DIR}/python; a wheel has it as the components `python` and
# `jit` of the installation (python/pyproject.toml, python/jit/pyproject.toml).
set(ANHOLON_MODULE_PYTHON "" CACHE FILEPATH "An interpreter that has nanobind; empty: the Python module is not built")

function(anholon_python_module)
  if(SKBUILD)
    set(ANHOLON_MODULE_PYTHON "${Python_EXECUTABLE}")
    if(TARGET anholon_jit)
      install(TARGETS anholon_jit LIBRARY DESTINATION anholon COMPONENT jit)
      install(FILES /usr/share/doc/llvm-19-dev/copyright DESTINATION anholon/licences RENAME llvm.txt COMPONENT jit OPTIONAL)
      install(FILES /usr/share/doc/libzstd1/copyright DESTINATION anholon/licences RENAME zstd.txt COMPONENT jit OPTIONAL)
    endif()
  endif()
  if(NOT ANHOLON_MODULE_PYTHON OR NOT TARGET anholon_api OR SKBUILD_PROJECT_NAME STREQUAL "anholon-jit")
    return()
  endif()
  set(Python_EXECUTABLE "${ANHOLON_MODULE_PYTHON}")
  find_package(Python 3.11 REQUIRED COMPONENTS Interpreter Development.Module ${SKBUILD_SABI_COMPONENT})
  execute_process(COMMAND "${Python_EXECUTABLE}" -m nanobind --cmake_dir
    OUTPUT_STRIP_TRAILING_WHITESPACE OUTPUT_VARIABLE nanobind_ROOT COMMAND_ERROR_IS_FATAL ANY)
  find_package(nanobind CONFIG REQUIRED)
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/python/core/*.cpp")
  file(GLOB modules CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/python/anholon/*")
  nanobind_add_module(anholon_python NB_STATIC STABLE_ABI LTO ${sources})
  set(place "${CMAKE_BINARY_DIR}/python/anholon")
  set_target_properties(anholon_python PROPERTIES OUTPUT_NAME "_core" LIBRARY_OUTPUT_DIRECTORY "${place}")
  target_include_directories(anholon_python PRIVATE "${PROJECT_SOURCE_DIR}/include")
  # The layers themselves are linked and none of their names is exported, since other modules in the process may
  # contain the same libraries.
  target_link_libraries(anholon_python PRIVATE anholon_api anholon_options)
  target_link_options(anholon_python PRIVATE -Wl,--exclude-libs,ALL -Wl,--gc-sections)
  nanobind_add_stub(anholon_python_stub MODULE anholon._core OUTPUT "${place}/_core.pyi"
    PYTHON_PATH "${CMAKE_BINARY_DIR}/python" DEPENDS anholon_python)
  install(TARGETS anholon_python LIBRARY DESTINATION anholon COMPONENT python)
  install(FILES "${place}/_core.pyi" DESTINATION anholon COMPONENT python)
  # The module of the widget, if npm has built the viewer.
  install(FILES "${PROJECT_SOURCE_DIR}/viewer/dist/widget.js" DESTINATION anholon COMPONENT python OPTIONAL)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/models/" DESTINATION anholon/share/anholon/models COMPONENT python)
  anholon_install_licences(anholon/licences python)
  file(GLOB nanobind_licence "${nanobind_ROOT}/../../nanobind-*.dist-info/licenses/LICENSE")
  install(FILES ${nanobind_licence} DESTINATION anholon/licences COMPONENT python RENAME nanobind.txt)
  if(TARGET anholon_jit)
    add_dependencies(anholon_python anholon_jit)
    add_custom_command(TARGET anholon_python POST_BUILD
      COMMAND "${CMAKE_COMMAND}" -E create_symlink "$<TARGET_FILE:anholon_jit>" "${place}/anholon-compiler.so")
  endif()
  # Python files are linked to their place in the source tree.
  file(MAKE_DIRECTORY "${place}")
  file(CREATE_LINK "${PROJECT_SOURCE_DIR}/viewer/dist/widget.js" "${place}/widget.js" SYMBOLIC)
  foreach(module IN LISTS modules)
    get_filename_component(name "${module}" NAME)
    file(CREATE_LINK "${module}" "${place}/${name}" SYMBOLIC)
  endforeach()
endfunction()
