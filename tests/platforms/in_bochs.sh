#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs a program on a processor with AVX-512 that Bochs emulates, since the qemu of Debian 12 has none: boots Debian's kernel
# from a CD whose only files are the program, its libraries and the .bxt files of this folder, which takes a minute, and runs it at some 30 million instructions a second. Prints what it prints (standard output and
# error are one there) and ends with its exit status.
#   in_bochs.sh PROGRAM [ARG...]
# Environment: BOXTREE_BOCHS, a folder for the kernel [bochs]; BOXTREE_BOCHS_MODEL, of `bochs --help cpu`
# [corei7_icelake_u, which has VBMI2, too]
set -euo pipefail
folder=$(realpath -m "${BOXTREE_BOCHS:-bochs}")
model=${BOXTREE_BOCHS_MODEL:-corei7_icelake_u}
# shellcheck source=samples/packages.sh
. "$(dirname "$0")/../../samples/packages.sh"
install_missing bochs bochsbios vgabios isolinux syslinux-common xorriso cpio busybox-static >&2
mkdir -p "$folder"
kernel=("$folder"/kernel/boot/vmlinuz-*)
if [ ! -f "${kernel[0]}" ]; then
  # What the package of the newest kernel depends on. Without installing it: no other system is booted here.
  name=$(apt-cache depends linux-image-cloud-amd64 | awk '/Depends: linux-image/ {print $2; exit}')
  (cd "$folder" && apt-get download -qq -o APT::Sandbox::User=root "$name" 2>&1 && dpkg -x "$name"_*.deb kernel) >&2
  kernel=("$folder"/kernel/boot/vmlinuz-*)
fi

run=$(mktemp -d "$folder/run.XXXXXX")
trap 'rm -rf "$run"' EXIT
mkdir -p "$run/root/bin" "$run/root/files" "$run/root/proc" "$run/cd"
cp "$(command -v busybox)" "$run/root/bin/"
cp "$1" "$run/root/program"
{ ldd "$1" 2>/dev/null || true; } | { grep -o '/[^ ]*' || true; } | while read -r library; do cp -L --parents "$library" "$run/root"; done
shift
cp ./*.bxt "$run/root/files/"
# The program's status is the last line, behind a mark that no program prints.
{
  printf '#!/bin/busybox sh\ncd /files\necho BEGIN-OF-RUN\n/program'
  printf ' %q' "$@"
  # The serial line sends what it has.
  printf '\necho "END-OF-RUN $?"\n/bin/busybox sleep 2\n/bin/busybox poweroff -f\n'
} >"$run/root/init"
chmod +x "$run/root/init"
(cd "$run/root" && find . | cpio -o -H newc --quiet | gzip -1) >"$run/cd/initrd"
cp "${kernel[0]}" "$run/cd/linux"
cp /usr/lib/ISOLINUX/isolinux.bin /usr/lib/syslinux/modules/bios/ldlinux.c32 "$run/cd/"
# Left out is what of Bochs 2.7 the kernel does not trust (sizes of saved states that are compacted or hold pku) and what it
# does not boot with; the program still sees all of the processor. No security modules, which take minutes to start.
cat >"$run/cd/isolinux.cfg" <<'CONFIG'
DEFAULT linux
PROMPT 0
LABEL linux
  LINUX /linux
  INITRD /initrd
  APPEND console=ttyS0,115200 loglevel=0 mitigations=off lsm= apparmor=0 clearcpuid=aperfmperf,pku,xsaves,xsavec,umip,fsrm,rdpid,sha_ni,gfni,vaes,vpclmulqdq nopku
CONFIG
xorriso -as mkisofs -quiet -o "$run/cd.iso" -b isolinux.bin -c boot.cat -no-emul-boot -boot-load-size 4 \
  -boot-info-table "$run/cd" 2>"$run/xorriso.txt" || { cat "$run/xorriso.txt" >&2; exit 1; }
cat >"$run/bochsrc" <<CONFIG
cpu: model=$model, count=1, ips=50000000, reset_on_triple_fault=0
memory: guest=512, host=512
romimage: file=/usr/share/bochs/BIOS-bochs-latest
vgaromimage: file=/usr/share/vgabios/vgabios.bin
ata0-master: type=cdrom, path=$run/cd.iso, status=inserted
boot: cdrom
com1: enabled=1, mode=file, dev=$run/serial.txt
log: $run/bochs.txt
display_library: rfb, options="timeout=0"
panic: action=report
CONFIG
# Debian builds it with its debugger, which waits for a command.
printf 'continue\nquit\n' >"$run/commands"
bochs -q -f "$run/bochsrc" -rc "$run/commands" </dev/null >"$run/screen.txt" 2>&1 || true
tr -d '\r' <"$run/serial.txt" | sed -n '/^BEGIN-OF-RUN$/,/^END-OF-RUN /{/-OF-RUN/!p}'
status=$(tr -d '\r' <"$run/serial.txt" | sed -n 's/^END-OF-RUN \([0-9]*\)$/\1/p')
if [ -z "$status" ]; then
  tail -n 5 "$run/serial.txt" >&2
  echo "in_bochs.sh: the emulated machine did not run the program to its end" >&2
  exit 1
fi
exit "$status"
