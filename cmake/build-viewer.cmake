# cmake -DVIEWER=folder -DPAGE=file -DNPM=program -P build-viewer.cmake: writes PAGE.
# Several build folders may come here at once, so one at a time.

function(use_fallback reason)
  message(WARNING "The browser page is not built: ${reason}\nReports will say how to get it.")
  configure_file(${VIEWER}/fallback.html ${PAGE} COPYONLY)
  file(TOUCH ${PAGE} ${PAGE}.missing)
endfunction()

function(run_or_fall_back what)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${VIEWER} RESULT_VARIABLE status
    OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    use_fallback("${what} failed (${status})\n${output}")
    set(failed TRUE PARENT_SCOPE)
  endif()
endfunction()

get_filename_component(folder ${PAGE} DIRECTORY)
file(MAKE_DIRECTORY ${folder})
if(NOT NPM)
  use_fallback("npm was not found; install the Debian packages nodejs and npm")
  return()
endif()
file(LOCK ${VIEWER}/.build.lock GUARD PROCESS TIMEOUT 600)
# npm keeps the list of what it installed here; it is as new as the last `npm ci`.
set(installed ${VIEWER}/node_modules/.package-lock.json)
if(NOT EXISTS ${installed} OR ${VIEWER}/package-lock.json IS_NEWER_THAN ${installed})
  run_or_fall_back("npm ci" ${NPM} ci --no-audit --no-fund)
  if(failed)
    return()
  endif()
  file(TOUCH ${installed})
endif()
run_or_fall_back("npm run build" ${NPM} run build -- --outDir ${folder}/dist --emptyOutDir)
if(NOT failed)
  configure_file(${folder}/dist/report.html ${PAGE} COPYONLY)
  file(TOUCH ${PAGE})
endif()
