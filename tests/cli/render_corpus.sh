#!/usr/bin/env bash
# render_corpus.sh PROGRAM FOLDER: renders every glTF of a folder. Each must give its picture and exit 0, or one line that
# starts with "earthshine: ", no picture, and exit 1. Anything else (a crash, a sanitizer's report, a second line) fails.
set -u
program=$1 folder=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
rendered=0 refused=0 failed=0
while IFS= read -r file; do
    rm -f "$scratch"/*
    "$program" render "$file" -o "$scratch/picture.png" --size 64x36 --rsm-size 32 --shadow-size 64 --spp 8 --quiet \
        >"$scratch/stdout" 2>"$scratch/stderr"
    code=$?
    if [ $code -eq 0 ] && [ -s "$scratch/picture.png" ] && [ ! -s "$scratch/stderr" ]; then
        rendered=$((rendered + 1))
    elif [ $code -eq 1 ] && [ ! -e "$scratch/picture.png" ] && [ "$(wc -l <"$scratch/stderr")" -eq 1 ] &&
        grep -q '^earthshine: ' "$scratch/stderr"; then
        refused=$((refused + 1))
        sed 's/^earthshine: /refused: /' "$scratch/stderr"
    else
        failed=$((failed + 1))
        echo "FAILED with exit code $code: $file"
        cat "$scratch/stderr"
    fi
done < <(find "$folder" -name '*.gltf' -o -name '*.glb' | sort)
echo "$rendered rendered, $refused refused, $failed failed"
[ $failed -eq 0 ] && [ $rendered -gt 0 ]
