# All tests of ctest. Names: unit.<layer>.<Suite.Test>, <set>.<shard>, golden.<kind>.<case>, script.<name>.

find_package(GTest REQUIRED)
find_package(nlohmann_json REQUIRED)
include(GoogleTest)

# No test keeps compiled code in the home folder of the user.
set(no_cache "ANHOLON_CACHE=")

# The system's python is preferred: the shim of a version manager takes ten times as long to start.
find_program(ANHOLON_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(ANHOLON_PYTHON python3 REQUIRED)

set(test_optimization $<$<CONFIG:Release>:-Og;-g0>)
anholon_precompiled(tests OPTIONS ${test_optimization} LINKS anholon_setup GTest::gtest)

# The files of a layer or a set are compiled in batches (ANHOLON_UNITY). Each has a namespace that is named after it,
# so local names of two files do not clash.
function(anholon_test_executable target)
  add_executable(${target} ${ARGN})
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/test")
  target_compile_definitions(${target} PRIVATE ANHOLON_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  # The layers do the work, so the code of a test need not be fast, but must compile fast.
  anholon_use_precompiled(${target} tests)
  target_link_libraries(${target} PRIVATE anholon_options anholon_warnings
    nlohmann_json::nlohmann_json GTest::gtest GTest::gtest_main)
  if(TARGET anholon_jit)
    add_dependencies(${target} anholon_jit)
    target_compile_definitions(${target} PRIVATE ANHOLON_COMPILER_BUILT)
  endif()
endfunction()

# test/unit/<layer>/*_test.cpp: one executable per layer, one ctest test per TEST

get_property(layers GLOBAL PROPERTY ANHOLON_LAYERS)
foreach(layer IN LISTS layers)
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/test/unit/${layer}/*_test.cpp")
  if(sources)
    anholon_test_executable(test_${layer} ${sources})
    anholon_in_batches(test_${layer})
    # A test may use layers above its own: a test of mechanics reads a model file.
    anholon_link_layers(test_${layer})
    if(layer STREQUAL "cli")
      target_link_libraries(test_${layer} PRIVATE anholon_cli)
    endif()
    # Some motions are computed in multiple precision under ANHOLON_LONG=1 only.
    set(labels unit)
    if(layer STREQUAL "simulation")
      set(labels "unit;long")
    endif()
    gtest_discover_tests(test_${layer} TEST_PREFIX "unit.${layer}." PROPERTIES LABELS "${labels}" ENVIRONMENT "${no_cache}"
      DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60)
  endif()
endforeach()

if(ANHOLON_FOUND_hdf5)
  target_compile_definitions(test_result PRIVATE ANHOLON_HDF5)
endif()

# A form is added as one file: this program has the registry of the build with that file, and all other files of the
# build.

file(GLOB new_form "${PROJECT_SOURCE_DIR}/test/house/forms/*.cpp")
anholon_formulation_registry(registry_with_new_form NAME new_ EXTRA ${new_form})
anholon_test_executable(test_new_form test/house/new_form_test.cpp ${new_form} ${registry_with_new_form})
anholon_link_layers(test_new_form)
gtest_discover_tests(test_new_form TEST_PREFIX "house." PROPERTIES LABELS unit ENVIRONMENT "${no_cache}" DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60)

# A format of results is added as one file and a name in the table: this program has the commands of the build with
# that table in its place.

if(TARGET anholon_cli)
  file(GLOB new_format "${PROJECT_SOURCE_DIR}/test/house/formats/*.cpp")
  anholon_test_executable(test_new_format test/house/new_format_test.cpp ${new_format})
  anholon_link_layers(test_new_format)
  target_link_libraries(test_new_format PRIVATE anholon_cli)
  gtest_discover_tests(test_new_format TEST_PREFIX "house." PROPERTIES LABELS unit ENVIRONMENT "${no_cache}" DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60)
endif()

# test/<set>/*_test.cpp: one executable over all layers, run in shards
# Tests of a set share costly derivations within a process; shards keep that and use all cores.

file(GLOB support_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/test/support/*.cpp")
if(support_sources)
  add_library(anholon_test_support STATIC ${support_sources})
  anholon_use_precompiled(anholon_test_support tests)
  target_include_directories(anholon_test_support PUBLIC "${PROJECT_SOURCE_DIR}/test")
  target_compile_definitions(anholon_test_support PUBLIC ANHOLON_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  anholon_link_layers(anholon_test_support)
  target_link_libraries(anholon_test_support
    PRIVATE anholon_warnings PUBLIC nlohmann_json::nlohmann_json GTest::gtest)
endif()

function(anholon_test_set set)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "SHARDS" "LABELS")
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/test/${set}/*_test.cpp")
  if(NOT sources)
    return()
  endif()
  anholon_test_executable(test_${set} ${sources})
  anholon_in_batches(test_${set})
  if(TARGET anholon_test_support)
    target_link_libraries(test_${set} PRIVATE anholon_test_support)
  endif()
  anholon_link_layers(test_${set})
  math(EXPR last "${arg_SHARDS} - 1")
  foreach(shard RANGE ${last})
    add_test(NAME "${set}.${shard}" COMMAND test_${set} --gtest_brief=1)
    set_tests_properties("${set}.${shard}" PROPERTIES LABELS "${arg_LABELS}"
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${arg_SHARDS};GTEST_SHARD_INDEX=${shard};${no_cache}")
  endforeach()
endfunction()

# Label `long`: the test does more under ANHOLON_LONG=1; ./dev long runs it.
# Label `long-only`: left out of ./dev test.
anholon_test_set(oracle      SHARDS 4 LABELS oracle long)
anholon_test_set(laws        SHARDS 4 LABELS laws long)
anholon_test_set(backends    SHARDS 2 LABELS backends long)
target_sources(test_backends PRIVATE src/jit/packs.cpp src/jit/packed_memory.cpp)  # module parts without LLVM

# The translator of machine code is linked here by itself, as it is part of a module and not of the program.
if(TARGET anholon_jit)
  find_package(LLVM 19.1 REQUIRED CONFIG)
  file(GLOB translator CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/jit/x86/*.cpp")
  add_executable(test_jit test/jit/translator_test.cpp test/jit/random_code.cpp ${translator})
  target_include_directories(test_jit PRIVATE "${PROJECT_SOURCE_DIR}/src" "${PROJECT_SOURCE_DIR}/test")
  target_include_directories(test_jit SYSTEM PRIVATE ${LLVM_INCLUDE_DIRS})
  target_compile_options(test_jit PRIVATE -ffp-contract=off)
  anholon_use_precompiled(test_jit compiler)
  anholon_in_batches(test_jit)
  llvm_map_components_to_libnames(llvm core scalaropts)
  target_link_libraries(test_jit PRIVATE ${llvm} anholon_options anholon_warnings GTest::gtest GTest::gtest_main)
  gtest_discover_tests(test_jit TEST_PREFIX "unit.jit." PROPERTIES LABELS unit DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60)
endif()
anholon_test_set(determinism SHARDS 2 LABELS determinism long)
anholon_test_set(long        SHARDS 4 LABELS long-only)

# Scripts

function(anholon_script_test name)
  add_test(NAME "script.${name}" COMMAND ${ANHOLON_PYTHON} ${ARGN} WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
  set_tests_properties("script.${name}" PROPERTIES LABELS script ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;${no_cache}")
endfunction()

anholon_script_test(layers          tools/check_layers.py)
anholon_script_test(layers_selftest tools/check_layers.py --self-test)
anholon_script_test(house           tools/check_house.py)
anholon_script_test(house_selftest  tools/check_house.py --self-test)
anholon_script_test(formats         test/house/formats_by_table.py)
anholon_script_test(formats_selftest test/house/formats_by_table.py --self-test)
anholon_script_test(additions       test/house/files_to_touch.py $<TARGET_FILE:anholon>)
anholon_script_test(additions_selftest test/house/files_to_touch.py --self-test)
anholon_script_test(command_line    tools/command_line.py $<TARGET_FILE:anholon> --check)
anholon_script_test(version         tools/check_version.py $<TARGET_FILE:anholon>)
anholon_script_test(format          tools/check_format.py)
set_tests_properties(script.format PROPERTIES SKIP_RETURN_CODE 77)
anholon_script_test(refs            tools/check_refs.py)
anholon_script_test(refs_selftest   tools/check_refs.py --self-test)
anholon_script_test(links           tools/check_links.py)
anholon_script_test(links_selftest  tools/check_links.py --self-test)
anholon_script_test(pages_explain   tools/check_pages.py)
anholon_script_test(pages_selftest  tools/check_pages.py --self-test)
anholon_script_test(notebooks       tools/notebooks.py)
anholon_script_test(notebooks_selftest tools/notebooks.py --self-test)
anholon_script_test(golden_selftest tools/golden.py --self-test)
anholon_script_test(site            tools/site.py --check)
anholon_script_test(site_selftest   tools/site.py --self-test)
anholon_script_test(speed_selftest  bench/speed_report.py)
anholon_script_test(hostile_selftest test/hostile/run.py --self-test)
foreach(attack fields mutants certificates faults)
  anholon_script_test(${attack}_selftest test/attacks/${attack}.py --self-test)
endforeach()

# The Python module: its tests, the examples of its docstrings, its types.
if(TARGET anholon_python AND TARGET anholon)
  set(python_module "${CMAKE_BINARY_DIR}/python")
  function(anholon_python_test name)
    add_test(NAME "python.${name}" COMMAND "${ANHOLON_MODULE_PYTHON}" ${ARGN} WORKING_DIRECTORY "${python_module}")
    set_tests_properties("python.${name}" PROPERTIES LABELS python
      ENVIRONMENT "PYTHONPATH=${python_module};PYTHONDONTWRITEBYTECODE=1;ANHOLON_PROGRAM=$<TARGET_FILE:anholon>;${no_cache}")
  endfunction()
  set(settings "${PROJECT_SOURCE_DIR}/python/pyproject.toml")
  file(GLOB notebooks CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/python/notebooks/*.py")
  set(python_tests "${PROJECT_SOURCE_DIR}/python/tests")
  file(GLOB files CONFIGURE_DEPENDS "${python_tests}/test_*.py")
  foreach(file IN LISTS files)
    string(REGEX REPLACE ".*/test_(.*)\\.py" "\\1" name "${file}")
    anholon_python_test(${name} -m pytest -q -rs -c "${settings}" -p no:cacheprovider "${file}")
    # pytest returns 5 if a package that the whole file needs is missing.
    set_tests_properties("python.${name}" PROPERTIES SKIP_RETURN_CODE 5)
  endforeach()
  # These tests take minutes: memory of long runs, the compilers of other packages in the same process.
  set_tests_properties(python.long PROPERTIES LABELS "python;long-only")
  anholon_python_test(examples -m pytest -q -c "${settings}" -p no:cacheprovider --doctest-modules "${python_module}/anholon")
  set(workers "${PROJECT_SOURCE_DIR}/test/sweeps/workers.py" --program $<TARGET_FILE:anholon>)
  anholon_python_test(sweeps ${workers})
  set_tests_properties(python.sweeps PROPERTIES PROCESSORS 2)
  anholon_python_test(sweeps_selftest ${workers} --self-test)
  anholon_python_test(types -m mypy --config-file "${settings}" --cache-dir "${CMAKE_BINARY_DIR}/mypy" anholon "${python_tests}" ${notebooks})
  anholon_python_test(types_pyright -m pyright --pythonpath "${ANHOLON_MODULE_PYTHON}" anholon ${notebooks})
endif()

if(TARGET anholon)
  # A separate project uses the installed library.
  anholon_script_test(outside tools/check_outside.py ${CMAKE_BINARY_DIR} --compiler ${CMAKE_CXX_COMPILER})
  anholon_script_test(readme tools/readme.py --program $<TARGET_FILE:anholon>)
  anholon_script_test(commands tools/commands.py --program $<TARGET_FILE:anholon>)
  anholon_script_test(commands_selftest tools/commands.py --program $<TARGET_FILE:anholon> --self-test)
  anholon_script_test(reference tools/reference.py --program $<TARGET_FILE:anholon>)
  anholon_script_test(reference_selftest tools/reference.py --program $<TARGET_FILE:anholon> --self-test)
  anholon_script_test(papers_tables tools/papers.py --program $<TARGET_FILE:anholon>)
  anholon_script_test(papers_selftest tools/papers.py --program $<TARGET_FILE:anholon> --self-test)
  # Decides every claim of the papers.
  add_test(NAME papers.check COMMAND anholon papers --check --quiet)
  set_tests_properties(papers.check PROPERTIES LABELS laws)
  anholon_script_test(h5py test/house/read_with_h5py.py $<TARGET_FILE:anholon>)
  set_tests_properties(script.h5py PROPERTIES SKIP_RETURN_CODE 77)
  anholon_script_test(render test/house/render_disc.py $<TARGET_FILE:anholon>)
  set_tests_properties(script.render PROPERTIES SKIP_RETURN_CODE 77)
  anholon_script_test(gallery_selftest tools/gallery.py --program $<TARGET_FILE:anholon> --self-test)
  anholon_script_test(generated test/backends/check_generated.py $<TARGET_FILE:anholon>)
  set_tests_properties(script.generated PROPERTIES LABELS "script;long")
  # Evaluation and motion of every reference system by a form without multipliers; ./dev long runs them by every form.
  anholon_script_test(oracle_chaplygin test/oracle/check_models.py $<TARGET_FILE:anholon> --form chaplygin --jobs 1)
  anholon_script_test(oracle_all_forms test/oracle/check_models.py $<TARGET_FILE:anholon> --form all)
  set_tests_properties(script.oracle_all_forms PROPERTIES LABELS long-only)
  # The digits to trust, compared with 30 digits: some runs here; ./dev long compares all 650 runs and 60 sweeps.
  anholon_script_test(estimate_selftest test/estimate/run.py $<TARGET_FILE:anholon> --jobs 1 --self-test)
  anholon_script_test(estimate test/estimate/run.py $<TARGET_FILE:anholon> --jobs 2)
  set_tests_properties(script.estimate PROPERTIES LABELS "script;long" PROCESSORS 2)
  # Sanitizers need more time and address space than the limits leave.
  set(no_limits "")
  if(ANHOLON_SANITIZE)
    set(no_limits --no-limits)
  endif()
  anholon_script_test(hostile test/hostile/run.py --program $<TARGET_FILE:anholon> ${no_limits})
  set_tests_properties(script.hostile PROPERTIES PROCESSORS 2)
  # The traces of attacks and faults: few of them here, all with ANHOLON_LONG.
  foreach(attack fields mutants certificates)
    set(limits "")
    if(attack STREQUAL "mutants")
      set(limits ${no_limits})
    endif()
    anholon_script_test(${attack} test/attacks/${attack}.py --program $<TARGET_FILE:anholon> ${limits})
    set_tests_properties(script.${attack} PROPERTIES LABELS "script;long" PROCESSORS 2)
  endforeach()
  # Sweeps in folders, with kills, stops, shares and full disks: few here, 40 kills with ANHOLON_LONG.
  anholon_script_test(sweeps test/sweeps/folders.py --program $<TARGET_FILE:anholon>)
  set_tests_properties(script.sweeps PROPERTIES LABELS "script;long" PROCESSORS 2)
  anholon_script_test(sweeps_selftest test/sweeps/folders.py --program $<TARGET_FILE:anholon> --self-test)
  anholon_script_test(faults test/attacks/faults.py --program $<TARGET_FILE:anholon>)
  set_tests_properties(script.faults PROPERTIES LABELS long-only PROCESSORS 2)
  anholon_script_test(studio test/studio/server.py --program $<TARGET_FILE:anholon>)
  set_tests_properties(script.studio PROPERTIES SKIP_RETURN_CODE 77)
  anholon_script_test(studio_selftest test/studio/server.py --self-test)
  anholon_script_test(studio_sweeps test/studio/sweeps.py --program $<TARGET_FILE:anholon>)
  set_tests_properties(script.studio_sweeps PROPERTIES SKIP_RETURN_CODE 77)
  anholon_script_test(studio_sweeps_selftest test/studio/sweeps.py --self-test)
  # Pages of real models in a browser; left out if there is no browser or no viewer.
  find_program(ANHOLON_NODE node)
  if(ANHOLON_NODE)
    add_test(NAME script.pages COMMAND "${ANHOLON_NODE}" test/report/pages.mjs $<TARGET_FILE:anholon> WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
    set_tests_properties(script.pages PROPERTIES LABELS "script;long" SKIP_RETURN_CODE 77 ENVIRONMENT "${no_cache}")
    add_test(NAME script.accessibility_selftest COMMAND "${ANHOLON_NODE}" test/site/accessibility.mjs --self-test WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
    set_tests_properties(script.accessibility_selftest PROPERTIES LABELS script SKIP_RETURN_CODE 77)
    add_test(NAME script.site_search COMMAND "${ANHOLON_NODE}" test/site/search.mjs WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
    add_test(NAME script.site_search_selftest COMMAND "${ANHOLON_NODE}" test/site/search.mjs --self-test WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
    set_tests_properties(script.site_search script.site_search_selftest PROPERTIES LABELS script)
    add_test(NAME script.studio_page COMMAND "${ANHOLON_NODE}" test/studio/page.mjs $<TARGET_FILE:anholon> WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
    set_tests_properties(script.studio_page PROPERTIES LABELS "script;long" SKIP_RETURN_CODE 77 TIMEOUT 600)
    add_test(NAME script.sweep_pages COMMAND "${ANHOLON_NODE}" test/studio/sweeps.mjs $<TARGET_FILE:anholon> WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
    set_tests_properties(script.sweep_pages PROPERTIES LABELS "script;long" SKIP_RETURN_CODE 77 TIMEOUT 600)
    add_test(NAME script.viewer COMMAND "${ANHOLON_NODE}" tools/test.mjs WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}/viewer")
    set_tests_properties(script.viewer PROPERTIES LABELS long-only)
  endif()
  anholon_script_test(mathml tools/check_mathml.py --program $<TARGET_FILE:anholon>)

  file(GLOB cases CONFIGURE_DEPENDS RELATIVE "${PROJECT_SOURCE_DIR}/test/golden"
    "${PROJECT_SOURCE_DIR}/test/golden/good/*.md" "${PROJECT_SOURCE_DIR}/test/golden/bad/*.md")
  foreach(case IN LISTS cases)
    string(REGEX REPLACE "\\.md$" "" name "${case}")
    string(REPLACE "/" "." name "${name}")
    add_test(NAME "golden.${name}" WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
      COMMAND ${ANHOLON_PYTHON} tools/golden.py --program $<TARGET_FILE:anholon> "test/golden/${case}")
    set_tests_properties("golden.${name}" PROPERTIES LABELS golden ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;${no_cache}")
  endforeach()

  # Pages of doc/ whose commands are run in the same way: doc.<part>.<page>, or doc.<page>
  set(doc_folder "${PROJECT_SOURCE_DIR}/doc")
  file(GLOB pages CONFIGURE_DEPENDS RELATIVE "${doc_folder}"
    "${doc_folder}/book/*.md" "${doc_folder}/recipes/*.md" "${doc_folder}/asked/*.md" "${doc_folder}/from/*.md" "${doc_folder}/sweeps.md")
  foreach(page IN LISTS pages)
    file(STRINGS "${doc_folder}/${page}" commands REGEX "^```console")
    if(commands)
      string(REGEX REPLACE "\\.md$" "" name "${page}")
      string(REPLACE "/" "." name "${name}")
      add_test(NAME "doc.${name}" WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
        COMMAND ${ANHOLON_PYTHON} tools/golden.py --program $<TARGET_FILE:anholon> "doc/${page}")
      set_tests_properties("doc.${name}" PROPERTIES LABELS golden ENVIRONMENT "PYTHONDONTWRITEBYTECODE=1;${no_cache}")
    endif()
  endforeach()

  if(ANHOLON_SAME_BITS_WITH)
    anholon_script_test(same_bits tools/same_bits.py $<TARGET_FILE:anholon> "${ANHOLON_SAME_BITS_WITH}")
    set_tests_properties(script.same_bits PROPERTIES SKIP_RETURN_CODE 77 LABELS "script;determinism")
  endif()
endif()
