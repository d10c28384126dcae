#include "board.h"

#define CPACR (*(volatile uint32_t *)0xE000ED88u)
#define SYST_CSR (*(volatile uint32_t *)0xE000E010u)
#define SYST_RVR (*(volatile uint32_t *)0xE000E014u)
#define SYST_CVR (*(volatile uint32_t *)0xE000E018u)
#define TICKS 0x00FFFFFFu
#define TICKS_PER_INSTRUCTION 25.6

extern char board_stack_top[];
extern char board_data_load[], board_data_start[], board_data_end[], board_bss_start[], board_bss_end[];

int main(void);
void board_reset(void);
static void board_fault(void);

typedef union {
    void (*handler)(void);
    void *stack;
} vector_t;

__attribute__((section(".vectors"), used)) static const vector_t vectors[16] = {
    {.stack = board_stack_top}, {board_reset}, {board_fault}, {board_fault},
    {board_fault}, {board_fault}, {board_fault}};

static intptr_t service(int operation, const void *argument) {
    register intptr_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

void board_reset(void) {
    CPACR |= 0xFu << 20; /* the floating point unit is off after reset */
    __asm__ volatile("dsb\n\tisb" ::: "memory");
    const char *from = board_data_load;
    for (char *to = board_data_start; to != board_data_end; to++) {
        *to = *from++;
    }
    for (char *to = board_bss_start; to != board_bss_end; to++) {
        *to = 0;
    }
    board_exit(main());
}

static void board_fault(void) {
    board_print("fault\n");
    board_exit(1);
}

void board_print(const char *text) {
    (void)service(0x04 /* SYS_WRITE0 */, text);
}

void board_print_number(double value, int decimals) {
    char digits[32];
    int place = sizeof digits - 1;
    digits[place] = '\0';
    double scaled = value < 0 ? -value : value;
    for (int k = 0; k < decimals; k++) {
        scaled *= 10;
    }
    if (!(scaled < 4e9)) {
        board_print("(too large)");
        return;
    }
    uint32_t rest = (uint32_t)(scaled + 0.5);
    for (int k = 0; rest != 0 || k <= decimals; k++) {
        if (k == decimals && decimals != 0) {
            digits[--place] = '.';
        }
        digits[--place] = (char)('0' + rest % 10);
        rest /= 10;
    }
    if (value < 0) {
        digits[--place] = '-';
    }
    board_print(&digits[place]);
}

void board_exit(int code) {
    const uint32_t block[] = {0x20026u /* the application ended */, (uint32_t)code};
    (void)service(0x20 /* SYS_EXIT_EXTENDED */, block);
    for (;;) {
    }
}

void board_start_ticks(void) {
    SYST_RVR = TICKS;
    SYST_CVR = 0;
    SYST_CSR = 5; /* on, processor clock, no interrupt */
}

uint32_t board_ticks(void) {
    return SYST_CVR;
}

double board_instructions(uint32_t before, uint32_t after) {
    return ((before - after) & TICKS) / TICKS_PER_INSTRUCTION;
}
