// SPDX-License-Identifier: Apache-2.0
// A function of the program for each that it calls of libraries which are loaded late, by the same
// name. Called for the first time, it has the library loaded and learns where the function is
// (late_calls.cpp); from then on it jumps there. Arguments are where calls have them, and stay there.
// late_calls.inc: a line "late_call NAME, MODULE" for each, by list_late_calls.sh.

// What late_calls.cpp knows as LateCall: where to jump to, the function's name and its module's.
        .macro late_call_data name, module
        .section .rodata
0:      .asciz "\name"
3:      .asciz "\module"
        .data
        .balign 8
1:      .quad 2f
        .quad 0b
        .quad 3b
        .endm

#if defined(__x86_64__)

        .macro late_call name, module
        late_call_data \name, \module
        .text
        .globl \name
        .type \name, @function
\name:  jmp *1b(%rip)
2:      lea 1b(%rip), %r11
        jmp bind_late_call
        .size \name, . - \name
        .endm

        .text
        .type bind_late_call, @function
bind_late_call:
        .cfi_startproc
        .irp register, rdi, rsi, rdx, rcx, r8, r9, rax
        push %\register
        .cfi_adjust_cfa_offset 8
        .endr
        sub $128, %rsp
        .cfi_adjust_cfa_offset 128
        .irp i, 0, 1, 2, 3, 4, 5, 6, 7
        movups %xmm\i, 16 * \i(%rsp)
        .endr
        mov %r11, %rdi
        call deltasplat_bind_late_call@PLT
        mov %rax, %r11
        .irp i, 0, 1, 2, 3, 4, 5, 6, 7
        movups 16 * \i(%rsp), %xmm\i
        .endr
        add $128, %rsp
        .cfi_adjust_cfa_offset -128
        .irp register, rax, r9, r8, rcx, rdx, rsi, rdi
        pop %\register
        .cfi_adjust_cfa_offset -8
        .endr
        jmp *%r11
        .cfi_endproc
        .size bind_late_call, . - bind_late_call

// See open_library.h: who looks for handlers of an exception finds no way past it, and ends there.
        .globl deltasplat_dlopen
        .type deltasplat_dlopen, @function
deltasplat_dlopen:
        sub $8, %rsp
        call dlopen@PLT
        add $8, %rsp
        ret
        .size deltasplat_dlopen, . - deltasplat_dlopen

#elif defined(__aarch64__)

        .macro late_call name, module
        late_call_data \name, \module
        .text
        .balign 4
        .globl \name
        .type \name, %function
\name:  adrp x16, 1b
        add x16, x16, :lo12:1b
        ldar x17, [x16]
        br x17
2:      b bind_late_call
        .size \name, . - \name
        .endm

        .text
        .balign 4
        .type bind_late_call, %function
bind_late_call:
        .cfi_startproc
        stp x29, x30, [sp, -224]!
        .cfi_def_cfa_offset 224
        .cfi_offset 29, -224
        .cfi_offset 30, -216
        stp x0, x1, [sp, 16]
        stp x2, x3, [sp, 32]
        stp x4, x5, [sp, 48]
        stp x6, x7, [sp, 64]
        str x8, [sp, 80]
        stp q0, q1, [sp, 96]
        stp q2, q3, [sp, 128]
        stp q4, q5, [sp, 160]
        stp q6, q7, [sp, 192]
        mov x0, x16
        bl deltasplat_bind_late_call
        mov x17, x0
        ldp q6, q7, [sp, 192]
        ldp q4, q5, [sp, 160]
        ldp q2, q3, [sp, 128]
        ldp q0, q1, [sp, 96]
        ldr x8, [sp, 80]
        ldp x6, x7, [sp, 64]
        ldp x4, x5, [sp, 48]
        ldp x2, x3, [sp, 32]
        ldp x0, x1, [sp, 16]
        ldp x29, x30, [sp], 224
        .cfi_restore 29
        .cfi_restore 30
        .cfi_def_cfa_offset 0
        br x17
        .cfi_endproc
        .size bind_late_call, . - bind_late_call

        .globl deltasplat_dlopen
        .type deltasplat_dlopen, %function
deltasplat_dlopen:
        stp x29, x30, [sp, -16]!
        bl dlopen
        ldp x29, x30, [sp], 16
        ret
        .size deltasplat_dlopen, . - deltasplat_dlopen

#else
#error "late_calls.S: no calls for this processor; tools/CMakeLists.txt links the libraries instead"
#endif

#include "late_calls.inc"

        .section .note.GNU-stack, "", %progbits
