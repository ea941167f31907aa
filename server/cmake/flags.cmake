# Determinism (server/docs/determinism.md): no contraction of products and sums, no fast-math, and the mathematical functions come
# from the host's libm instead of from the compiler. Plugins that are built elsewhere get these flags with the SDK.
add_library(plab_determinism INTERFACE)
set_target_properties(plab_determinism PROPERTIES EXPORT_NAME determinism)
target_compile_options(plab_determinism INTERFACE
  -ffp-contract=off -fno-math-errno
  -fno-builtin-sin -fno-builtin-cos -fno-builtin-tan -fno-builtin-asin -fno-builtin-acos -fno-builtin-atan
  -fno-builtin-atan2 -fno-builtin-exp -fno-builtin-log -fno-builtin-pow)

# One set of flags for everything here.
add_library(plab_flags INTERFACE)
target_link_libraries(plab_flags INTERFACE plab_determinism)
target_compile_options(plab_flags INTERFACE -Wall -Wextra -Wconversion -Wshadow)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 sees overflows in inlined std::string that are not there (GCC bugs 105329, 105651, 105762).
  target_compile_options(plab_flags INTERFACE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-maybe-uninitialized)
endif()
if(PLAB_WARNINGS_AS_ERRORS)
  target_compile_options(plab_flags INTERFACE -Werror)
endif()
if(PLAB_SANITIZE)
  target_compile_options(plab_flags INTERFACE -fsanitize=${PLAB_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    -fno-sanitize=vptr)  # type information is hidden in each plugin, so vptr checks cannot compare it
  target_link_options(plab_flags INTERFACE -fsanitize=${PLAB_SANITIZE})
endif()
