/* The board without an operating system: start-up, and files by semihosting (Arm; RISC-V calls the same services). */
#include "board.h"

const uint32_t board_watched = WATCHED;

extern char board_stack_top[];

int main(void);
void board_main(void);

#if defined(__riscv)
__asm__(".section .text.board_start, \"ax\"\n"
        ".option push\n"
        ".option arch, +zicsr\n"
        ".global board_start\n"
        "board_start:\n"
        "    la sp, board_stack_top\n"
        "    la tp, board_tls\n"
        "    li t0, 0x6000\n" /* mstatus.FS: floating point on, where there is any */
        "    csrs mstatus, t0\n"
        "    j board_main\n"
        ".option pop\n"
        /* three instructions, uncompressed and on one page, are the call of a service */
        ".section .text.board_service, \"ax\"\n"
        ".balign 16\n"
        ".option push\n"
        ".option norvc\n"
        "board_service:\n"
        "    slli zero, zero, 0x1f\n"
        "    ebreak\n"
        "    srai zero, zero, 7\n"
        "    ret\n"
        ".option pop\n"
        ".text\n");
intptr_t board_service(int operation, const void *argument);
#else
void board_start(void);

__attribute__((section(".vectors"), used)) static void *const vectors[] = {board_stack_top, (void *)board_start};

void board_start(void) {
#if defined(__ARM_FP)
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* CPACR: full access to the floating point unit */
    __asm__ volatile("dsb\n\tisb" ::: "memory");
#endif
    board_main();
}

static intptr_t board_service(int operation, const void *argument) {
    register intptr_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}
#endif

enum { SYS_OPEN = 1, SYS_CLOSE = 2, SYS_WRITE = 5, SYS_READ = 6, SYS_EXIT_EXTENDED = 0x20 };
#define APPLICATION_EXIT 0x20026u

void board_main(void) {
    board_exit(main());
}

int board_open(const char *name, int mode) {
    size_t length = 0;
    while (name[length] != '\0') {
        length++;
    }
    const uintptr_t block[] = {(uintptr_t)name, (uintptr_t)mode, length};
    const intptr_t file = board_service(SYS_OPEN, block);
    if (file < 0) {
        board_exit(2);
    }
    return (int)file;
}

static void move(int operation, int file, uintptr_t bytes, size_t count) {
    const uintptr_t block[] = {(uintptr_t)file, bytes, count};
    if (board_service(operation, block) != 0) { /* the number of bytes not moved */
        board_exit(2);
    }
}

void board_read(int file, void *bytes, size_t count) {
    move(SYS_READ, file, (uintptr_t)bytes, count);
}

/* A service takes an emulator longer than a kernel: what is written waits here until it is worth a call. */
static unsigned char waiting[4096];
static size_t waiting_count;
static int waiting_file;

static void flush(void) {
    if (waiting_count > 0u) {
        move(SYS_WRITE, waiting_file, (uintptr_t)waiting, waiting_count);
        waiting_count = 0u;
    }
}

void board_write(int file, const void *bytes, size_t count) {
    const unsigned char *next = bytes;
    if (file != waiting_file) {
        flush();
        waiting_file = file;
    }
    for (size_t k = 0; k < count; k++) {
        if (waiting_count == sizeof waiting) {
            flush();
        }
        waiting[waiting_count++] = next[k];
    }
}

void board_close(int file) {
    flush();
    const uintptr_t block[] = {(uintptr_t)file};
    (void)board_service(SYS_CLOSE, block);
}

void board_exit(int code) {
    flush();
    const uintptr_t block[] = {APPLICATION_EXIT, (uintptr_t)code};
    (void)board_service(SYS_EXIT_EXTENDED, block);
    for (;;) {
    }
}

__attribute__((noinline)) uintptr_t board_stack_pointer(void) {
    uintptr_t pointer;
#if defined(__riscv)
    __asm__ volatile("mv %0, sp" : "=r"(pointer));
#else
    __asm__ volatile("mov %0, sp" : "=r"(pointer));
#endif
    return pointer;
}
