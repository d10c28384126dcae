/*
 * A plug-in for QEMU's translator: how many instructions each call of a function executes.
 *
 * Arguments: calls=FILE, names the addresses of functions, one hexadecimal number a line; out=FILE, gets a pair of
 * 32-bit numbers (place of the function in that list, instructions from its first to its return) for every call.
 *
 * Translated blocks end at every branch, so a call begins where a block begins at the address of a function, and it
 * is over where the block begins that follows the caller's branch.  The prototypes are those of version 1 of the
 * plug-in interface; no header of QEMU is needed.
 */
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct qemu_plugin_tb;
struct qemu_plugin_insn;
typedef uint64_t qemu_plugin_id_t;
typedef struct qemu_info_t qemu_info_t;

void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                           void (*translated)(qemu_plugin_id_t id, struct qemu_plugin_tb *block));
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb *block, void (*entered)(unsigned int cpu, void *data),
                                          int flags, void *data);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*finished)(qemu_plugin_id_t id, void *data), void *data);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *block);
struct qemu_plugin_insn *qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *block, size_t place);
uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn *instruction);
size_t qemu_plugin_insn_size(const struct qemu_plugin_insn *instruction);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;

#define MOST_FUNCTIONS 1024

typedef struct {
    uint64_t start;
    uint64_t end; /* the address that follows it */
    uint32_t instructions;
    uint32_t function; /* place + 1 of the function that begins here, 0 for none */
} block_t;

static uint64_t functions[MOST_FUNCTIONS];
static uint32_t function_count;
static FILE *out;

static uint32_t running; /* place + 1 of the function that is being counted */
static uint32_t count;
static uint64_t back;
static uint64_t last_end;

static void entered(unsigned int cpu, void *data) {
    (void)cpu;
    const block_t *block = data;
    if (running != 0 && block->start == back) {
        const uint32_t pair[] = {running - 1, count};
        fwrite(pair, sizeof pair, 1, out);
        running = 0;
    }
    if (running != 0) {
        count += block->instructions;
    } else if (block->function != 0) {
        running = block->function;
        back = last_end;
        count = block->instructions;
    }
    last_end = block->end;
}

static void translated(qemu_plugin_id_t id, struct qemu_plugin_tb *given) {
    (void)id;
    block_t *block = calloc(1, sizeof *block); /* a block lives as long as the run */
    const size_t instructions = qemu_plugin_tb_n_insns(given);
    if (block == NULL || instructions == 0) {
        abort();
    }
    const struct qemu_plugin_insn *last = qemu_plugin_tb_get_insn(given, instructions - 1);
    block->start = qemu_plugin_insn_vaddr(qemu_plugin_tb_get_insn(given, 0));
    block->end = qemu_plugin_insn_vaddr(last) + qemu_plugin_insn_size(last);
    block->instructions = (uint32_t)instructions;
    for (uint32_t k = 0; k < function_count; k++) {
        if (functions[k] == block->start) {
            block->function = k + 1;
        }
    }
    qemu_plugin_register_vcpu_tb_exec_cb(given, entered, 0, block);
}

static void finished(qemu_plugin_id_t id, void *data) {
    (void)id;
    (void)data;
    fclose(out);
}

static bool read_functions(const char *path) {
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        return false;
    }
    while (function_count < MOST_FUNCTIONS && fscanf(file, "%" SCNx64, &functions[function_count]) == 1) {
        function_count++;
    }
    fclose(file);
    return function_count > 0;
}

__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t *info, int argc,
                                                               char **argv) {
    (void)info;
    bool known = false;
    for (int k = 0; k < argc; k++) {
        if (strncmp(argv[k], "calls=", 6) == 0) {
            known = read_functions(argv[k] + 6);
        } else if (strncmp(argv[k], "out=", 4) == 0) {
            out = fopen(argv[k] + 4, "wb");
        }
    }
    if (!known || out == NULL) {
        fputs("counter: needs calls=FILE and out=FILE\n", stderr);
        return -1;
    }
    qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
    qemu_plugin_register_atexit_cb(id, finished, NULL);
    return 0;
}
