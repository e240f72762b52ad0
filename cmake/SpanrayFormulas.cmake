# spanray_add_formula(TARGET FILE.inl...)
# Gives a program, or a shared library, reflectance formulas of its own: scene files then name them by file name
# (`reflectance = "toon"` in [material.NAME]). A formula file is written like those of engine/catalog/reflectance, which the
# package installs; it needs no `// index:` line. TARGET must link spanray::spanray. Needs the headers of GLM and Highway.
#
# How: formulas are compiled into kernels, and the installed library has its kernels already. So the few sources that read the
# catalog of reflectances are compiled once more, with these formulas in it, with the flags of the numerical contract and for every
# instruction set, and linked into TARGET as objects: what an object defines, the linker does not take from a static library.
# docs/decisions/0005-formulas.md says why.
include(${CMAKE_CURRENT_LIST_DIR}/SpanrayFlags.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/../engine/catalog/catalog.cmake)

# The sources that read the catalog of reflectances (tests/catalog_build_test.cpp holds this list to be all of them).
function(spanray_formula_sources out)
  set(${out} catalog/catalog.cpp shade/light_kernel.cpp shade/triangle_light_kernel.cpp shade/light_rays_kernel.cpp
      shade/resolve_kernel.cpp shade/direct_kernel.cpp PARENT_SCOPE)
endfunction()

function(spanray_add_formula target)
  if(NOT ARGN)
    message(FATAL_ERROR "spanray_add_formula(${target}): no formula file is named")
  endif()
  get_target_property(type ${target} TYPE)
  if(NOT type MATCHES "^(EXECUTABLE|SHARED_LIBRARY|MODULE_LIBRARY)$")
    # The linker would take a static library's objects only where something asks for them: too late, without a word.
    message(FATAL_ERROR "spanray_add_formula(${target}): name the program or shared library that links spanray, not a ${type}")
  endif()
  set(objects ${target}_spanray_formulas)
  if(TARGET ${objects})
    message(FATAL_ERROR "spanray_add_formula(${target}): called twice; name all formulas in one call")
  endif()
  set(files "")
  foreach(file ${ARGN})
    get_filename_component(file ${file} ABSOLUTE)
    if(NOT EXISTS ${file})
      message(FATAL_ERROR "spanray_add_formula(${target}): there is no file ${file}")
    endif()
    list(APPEND files ${file})
  endforeach()
  find_package(glm REQUIRED)
  find_package(hwy REQUIRED)

  get_filename_component(engine ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../engine ABSOLUTE)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/${objects})
  spanray_collect_catalog(${engine}/catalog ${generated} ${files})
  spanray_formula_sources(sources)
  list(TRANSFORM sources PREPEND ${engine}/)
  add_library(${objects} OBJECT ${sources})
  spanray_contract_flags(${objects})
  # Without optimization, kernels are a hundred times slower; the picture is the same.
  target_compile_options(${objects} PRIVATE $<$<NOT:$<CONFIG:Release,RelWithDebInfo,MinSizeRel>>:-O2>)
  target_compile_features(${objects} PRIVATE cxx_std_20)
  set_target_properties(${objects} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF)
  target_include_directories(${objects} PRIVATE ${generated} ${engine} ${engine}/include)
  target_link_libraries(${objects} PRIVATE spanray::spanray hwy::hwy)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
endfunction()
