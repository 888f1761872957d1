# Language level, warnings and sanitizers for the project's own targets.
add_library(isophote_build_flags INTERFACE)
target_compile_features(isophote_build_flags INTERFACE cxx_std_20)
target_compile_options(isophote_build_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  -Wno-missing-field-initializers)
if(ISOPHOTE_WERROR)
  target_compile_options(isophote_build_flags INTERFACE -Werror)
endif()
if(ISOPHOTE_SANITIZE)
  target_compile_options(isophote_build_flags INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer)
  target_link_options(isophote_build_flags INTERFACE -fsanitize=address,undefined)
endif()
