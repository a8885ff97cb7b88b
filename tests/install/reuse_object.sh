#!/bin/sh
# A compiler launcher: hands out an object that the build folder $BELTRAMI_BUILT has already, so
# that a test of the build's wiring does not compile the library again.
#   reuse_object.sh COMPILER ARGS... -o OBJECT ...
set -eu
previous='' object='' dependencies=''
for word in "$@"; do
  case $previous in
    -o) object=$word ;;
    -MF) dependencies=$word ;;
  esac
  previous=$word
done
built=$BELTRAMI_BUILT/${object#beltrami/}
if [ -n "$object" ] && [ -f "$built" ]; then
  cp "$built" "$object"
  if [ -n "$dependencies" ]; then echo "$object:" >"$dependencies"; fi
else
  exec "$@"
fi
