# CERTA_SANITIZE=address,undefined | thread: applied to everything that is compiled, tests included.
if(CERTA_SANITIZE)
  add_compile_options(-fsanitize=${CERTA_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=${CERTA_SANITIZE})
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
endif()
