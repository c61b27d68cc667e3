# Run at every build: writes OUTPUT from INPUT when the commit (or anything else in it) has changed.
find_program(GIT git)
set(COMMIT unknown)
if(GIT)
  # The checkout may belong to another user (a container's mount); asking it for its commit is harmless.
  set(git ${GIT} -c safe.directory=* -C ${SOURCE_DIR})
  execute_process(COMMAND ${git} rev-parse --show-toplevel OUTPUT_VARIABLE top ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  file(REAL_PATH ${SOURCE_DIR} real_source)
  if(top STREQUAL real_source)
    execute_process(COMMAND ${git} rev-parse --short=12 HEAD
      OUTPUT_VARIABLE COMMIT ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    execute_process(COMMAND ${git} status --porcelain --untracked-files=no OUTPUT_VARIABLE changes ERROR_QUIET)
    if(changes)
      string(APPEND COMMIT "+")
    endif()
  endif()
endif()
configure_file(${INPUT} ${OUTPUT} @ONLY)
