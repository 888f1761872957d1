# isophote_embed_kernels(target file.comp... [RAY_QUERY name...]): glslang -> spirv-val -> a C++ table linked into `target`.
# Kernels that stand after RAY_QUERY, by the stems of their files, are also compiled with ISOPHOTE_RAY_QUERY, as
# x_ray_query.
# A folder in the target's property ISOPHOTE_SHADER_OVERRIDES is searched for includes before the product's shaders.
# The kernel of x.comp is <target>_kernels::kernelSource("x"), declared in "<target>_kernels.hpp".
function(isophote_embed_kernels target)
  cmake_parse_arguments(arg "" "" "RAY_QUERY" ${ARGN})
  set(out ${CMAKE_CURRENT_BINARY_DIR}/${target}_kernels)
  file(MAKE_DIRECTORY ${out})
  get_target_property(overrides ${target} ISOPHOTE_SHADER_OVERRIDES)
  if(overrides)
    set(override_flags -I${overrides})
  endif()
  set(flags -V --target-env vulkan1.3 --quiet ${override_flags} -I${PROJECT_SOURCE_DIR}/shaders -I${PROJECT_SOURCE_DIR}/tests)
  if(ISOPHOTE_CHECK_BOUNDS)
    list(APPEND flags -DISOPHOTE_CHECK_BOUNDS=1)
  endif()
  set(binaries)
  foreach(source IN LISTS arg_UNPARSED_ARGUMENTS)
    get_filename_component(stem ${source} NAME_WE)
    set(variants "${stem}")
    if(stem IN_LIST arg_RAY_QUERY)
      list(APPEND variants ${stem}_ray_query)
    endif()
    foreach(name IN LISTS variants)
      set(variant_flags ${flags})
      if(NOT name STREQUAL stem)
        list(APPEND variant_flags -DISOPHOTE_RAY_QUERY=1)
      endif()
      set(spv ${out}/${name}.spv)
      add_custom_command(OUTPUT ${spv}
        COMMAND ${GLSLANG} ${variant_flags} --depfile ${spv}.d -o ${spv} ${source}
        COMMAND ${SPIRV_VAL} --target-env vulkan1.3 --scalar-block-layout ${spv}
        DEPENDS ${source} DEPFILE ${spv}.d COMMENT "GLSL ${name}" VERBATIM)
      list(APPEND binaries ${spv})
    endforeach()
  endforeach()
  add_custom_command(OUTPUT ${out}/${target}_kernels.cpp ${out}/${target}_kernels.hpp
    COMMAND ${CMAKE_COMMAND} -DTARGET=${target} -DOUT=${out} "-DBINARIES=${binaries}"
            -P ${PROJECT_SOURCE_DIR}/cmake/EmbedSpirv.cmake
    DEPENDS ${binaries} ${PROJECT_SOURCE_DIR}/cmake/EmbedSpirv.cmake COMMENT "Embedding kernels of ${target}" VERBATIM)
  target_sources(${target} PRIVATE ${out}/${target}_kernels.cpp ${out}/${target}_kernels.hpp)
  target_include_directories(${target} PRIVATE ${out})
endfunction()
