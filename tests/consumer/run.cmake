# Installs the package into a fresh folder, builds PROJECT against it there, and runs it.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message("${output}")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGV}")
  endif()
endfunction()

file(REMOVE_RECURSE ${FOLDER})
run(${CMAKE_COMMAND} --install ${BUILD} --component sdk --prefix ${FOLDER}/prefix)
run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${PROJECT} -B ${FOLDER}/build -DCMAKE_PREFIX_PATH=${FOLDER}/prefix -DCMAKE_CXX_COMPILER=${COMPILER} --no-warn-unused-cli
    -DCMAKE_DISABLE_FIND_PACKAGE_OpenImageIO=ON)
run(${CMAKE_COMMAND} --build ${FOLDER}/build)
run(${FOLDER}/build/lamp)
