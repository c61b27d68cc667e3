# CERTA_SANITIZE=address,undefined | thread: applied to everything that is compiled, tests included.
if(CERTA_SANITIZE)
  add_compile_options(-fsanitize=${CERTA_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=${CERTA_SANITIZE})
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
endif()

# Files full of CGAL's templates take twice as long to compile with UBSan's two checks of every pointer access; that leaves
# them with all other checks and with AddressSanitizer. Called once the library knows its files.
function(certa_relax_pointer_checks)
  if(NOT CERTA_SANITIZE MATCHES "undefined")
    return()
  endif()
  get_target_property(sources certa SOURCES)
  list(FILTER sources INCLUDE REGEX "/src/(exact|delaunay|conforming)/")
  set_property(SOURCE ${sources} TARGET_DIRECTORY certa PROPERTY COMPILE_OPTIONS -fno-sanitize=null,alignment)
endfunction()
