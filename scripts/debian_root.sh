# shellcheck shell=bash
# SPDX-License-Identifier: Apache-2.0
# To be sourced: a fresh Debian 12 (debootstrap's smallest system) in a temporary folder, for a
# script that defines inside(), and calls in_fresh_debian "$@" at its end. inside "$@" then runs in
# namespaces of its own, where it calls make_root and in_root. Whatever is mounted and started in
# there ends with it, and the folder is removed, even if the script is interrupted.
# The base system is kept in ${XDG_CACHE_HOME:-~/.cache}/deltasplat, a new one each month; the
# folder that ccache keeps is shared with the outside.
set -euo pipefail

script=$(realpath "$0")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
suite=bookworm
cache=${XDG_CACHE_HOME:-$HOME/.cache}/deltasplat
tarball=$cache/debian-12-minbase-$(dpkg --print-architecture)-$(date +%Y-%m).tar
folder=${DELTASPLAT_FRESH_FOLDER:-} # set inside
root=$folder/root
child=

fail() {
    echo "$(basename "$script"): $1" >&2
    exit 1
}

in_fresh_debian() {
    if [[ -n $folder ]]; then
        # As the first process of its namespace it hears only what it asks for.
        trap 'exit 143' HUP INT TERM
        inside "$@"
        return
    fi
    [[ $(id -u) -eq 0 ]] || fail "got user $(id -un); expected root (it mounts and runs chroot)"
    command -v debootstrap >/dev/null ||
        fail "got no debootstrap; expected it to be installed (bash scripts/install_dependencies.sh)"
    unshare --mount --pid --fork true ||
        fail "got no namespaces; expected a machine, or a container, that may make them and mount"
    [[ -z $(git status --porcelain) ]] || echo "NOTE: what is not committed is left out."

    folder=$(mktemp -d "${TMPDIR:-/tmp}/deltasplat-fresh.XXXXXX")
    trap remove_folder EXIT
    trap 'exit 129' HUP
    trap 'exit 130' INT
    trap 'exit 143' TERM
    # In the background, so that a signal is heard at once.
    DELTASPLAT_FRESH_FOLDER=$folder unshare --mount --pid --fork --kill-child \
        bash "$script" "$@" </dev/null &
    child=$!
    wait "$child"
}

remove_folder() {
    trap '' HUP INT TERM
    if [[ -n $child ]]; then
        kill -KILL "$child" 2>/dev/null || true
        wait "$child" 2>/dev/null || true
    fi
    # What was killed may take a moment to end.
    for _ in 1 2 3 4 5; do
        rm -rf --one-file-system "$folder" 2>/dev/null && return
        sleep 1
    done
    echo "$(basename "$script"): $folder could not be removed" >&2
}

# The mirror that this machine's own packages come from.
mirror() {
    local found
    found=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/*.{list,sources} 2>/dev/null |
        sed -nE 's@^(URIs:|deb )(.* )?(https?://[^ ]*/debian)/?( .*)?$@\3@p' | head -n 1 || true)
    echo "${found:-http://deb.debian.org/debian}"
}

make_base() {
    echo "Making a base system from $(mirror)"
    timeout 1200 debootstrap --variant=minbase "$suite" "$folder/base" "$(mirror)" \
        >"$folder/debootstrap.log" 2>&1 || {
        tail -n 20 "$folder/debootstrap.log" >&2
        fail "debootstrap made no $suite system from $(mirror); its last lines are above"
    }
    mkdir -p "$cache"
    # Another run may be making one as well.
    tar -C "$folder/base" --numeric-owner -cf "$tarball.$$" .
    rm -f "$cache"/debian-12-minbase-*.tar
    mv "$tarball.$$" "$tarball"
    rm -rf "$folder/base"
}

# Packages come from where this machine has them from, if it is a Debian of the same age.
copy_network() {
    local file
    cp /etc/resolv.conf "$root/etc/resolv.conf"
    apt-config dump | grep -E '^Acquire::' >"$root/etc/apt/apt.conf.d/99host" || true
    if [[ -f /etc/ssl/certs/ca-certificates.crt ]]; then
        mkdir -p "$root/etc/ssl/certs"
        cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
    fi
    grep -q "^VERSION_CODENAME=$suite$" /etc/os-release || return 0
    : >"$root/etc/apt/sources.list"
    for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.{list,sources}; do
        if [[ -f $file ]] && grep -qE "^[^#]*\s$suite" "$file"; then cp "$file" "$root$file"; fi
    done
    for file in /etc/apt/trusted.gpg.d /etc/apt/keyrings /usr/share/keyrings; do
        if [[ -d $file ]]; then mkdir -p "$root$file" && cp -r "$file/." "$root$file/"; fi
    done
}

mount_all() {
    mount -t proc proc "$root/proc"
    mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"
    mount -t tmpfs tmpfs "$root/dev/shm"
    # Data sets lie beside the tree, and cannot be written to.
    if [[ -d ../shared ]]; then
        mkdir "$root/root/shared"
        mount --bind ../shared "$root/root/shared"
        mount -o remount,bind,ro "$root/root/shared"
    fi
    # Compilers of the same version find here what they have compiled outside.
    if command -v ccache >/dev/null; then
        mkdir -p "$root/root/.cache/ccache" "$(ccache -k cache_dir)"
        mount --bind "$(ccache -k cache_dir)" "$root/root/.cache/ccache"
    fi
}

# Unpacks the base system, and clones what is committed to /root/deltasplat in it.
make_root() {
    [[ -f $tarball ]] || make_base
    mkdir "$root"
    tar -C "$root" --numeric-owner -xf "$tarball"
    # A system that is thrown away need not survive a power cut.
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io"
    copy_network
    mount_all
    git init --quiet "$root/root/deltasplat"
    git -C "$root/root/deltasplat" fetch --quiet --depth 1 "file://$PWD" HEAD
    git -C "$root/root/deltasplat" checkout --quiet --detach FETCH_HEAD
}

# Runs a line of shell in the clone.
in_root() {
    local name environment=(HOME=/root
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
        CCACHE_BASEDIR=/root/deltasplat CCACHE_NOHASHDIR=1)
    if command -v ccache >/dev/null; then
        environment+=(CCACHE_MAXSIZE="$(ccache -k max_size)")
    fi
    for name in http_proxy https_proxy no_proxy; do
        if [[ -n ${!name:-} ]]; then environment+=("$name=${!name}"); fi
    done
    # ccache tells compilers of different locales apart; those of other names are not there.
    for name in LANG LC_ALL LC_CTYPE LC_MESSAGES; do
        if [[ ${!name:-} == C* ]]; then environment+=("$name=${!name}"); fi
    done
    chroot "$root" env -i "${environment[@]}" \
        bash -euc "cd /root/deltasplat && $1" </dev/null
}
