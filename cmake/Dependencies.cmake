# Everything comes from the system's packages; nothing is downloaded. scripts/install-dependencies lists the packages.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON) # a project that adds this one as a subdirectory links them too
find_package(Vulkan REQUIRED)
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(glm REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
set(CMAKE_MESSAGE_LOG_LEVEL NOTICE) # Debian's Imath package lists a Python library it does not contain, and says so
find_package(OpenEXR REQUIRED)
unset(CMAKE_MESSAGE_LOG_LEVEL)
find_package(SPIRV-Tools-opt REQUIRED)
find_package(ZLIB REQUIRED)
pkg_check_modules(STB REQUIRED IMPORTED_TARGET GLOBAL stb)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET GLOBAL libturbojpeg)
find_program(GLSLANG glslangValidator REQUIRED)
find_program(SPIRV_VAL spirv-val REQUIRED)

# Compressed glTF; an asset that needs what is missing is refused.
find_package(meshoptimizer QUIET)
find_package(draco QUIET)
pkg_check_modules(WEBP QUIET IMPORTED_TARGET GLOBAL libwebp)

# Links what was found, and says so to the compiler in those of the target's `sources` that use it:
# ISOPHOTE_HAS_MESHOPT, ISOPHOTE_HAS_DRACO, ISOPHOTE_HAS_WEBP. The headers lie where all system headers do.
function(isophote_link_compression target)
  foreach(library meshoptimizer=MESHOPT=meshoptimizer::meshoptimizer draco=DRACO=draco::draco WEBP=WEBP=PkgConfig::WEBP)
    string(REPLACE "=" ";" parts ${library})
    list(GET parts 0 package)
    list(GET parts 1 name)
    list(GET parts 2 linked)
    if(${package}_FOUND)
      target_link_libraries(${target} PRIVATE $<LINK_ONLY:${linked}>)
      set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_DEFINITIONS ISOPHOTE_HAS_${name})
    endif()
  endforeach()
endfunction()
