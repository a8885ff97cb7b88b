#!/bin/sh
# A compiler launcher: hands out the library that the build folder $BELTRAMI_BUILT has already, so that a
# test of a build's wiring does not compile it again. The objects of its static library are linked into
# one: the first of the entry points is that one, and all others are empty.
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
all=$BELTRAMI_BUILT/src/beltrami_static.o
folder=${object%%.dir/*}.dir
case $folder in
  */beltrami_entry_points.dir | */beltrami_outer.dir | */beltrami_inner.dir | */beltrami_*_memory.dir) ;;
  *) all='' ;;
esac
if [ ! -f "$all" ]; then
  if command -v ccache >/dev/null; then set -- ccache "$@"; fi
  exec "$@"
fi
if [ "${folder##*/}" = beltrami_entry_points.dir ] && mkdir "$folder/handed-out" 2>/dev/null; then
  cp "$all" "$object"
else
  echo | "$1" -x c++ -c - -o "$object"
fi
if [ -n "$dependencies" ]; then echo "$object:" >"$dependencies"; fi
