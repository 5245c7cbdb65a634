// Counts the instructions that a program executes: a plugin for qemu's user mode. Its few declarations are those of
// qemu-plugin.h, which Debian's packages leave out.
#include <inttypes.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

int qemu_plugin_version = 1;

struct qemu_plugin_tb;
typedef void (*translated)(uint64_t id, struct qemu_plugin_tb *block);
typedef void (*at_exit)(uint64_t id, void *data);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *block);
void qemu_plugin_register_vcpu_tb_trans_cb(uint64_t id, translated callback);
void qemu_plugin_register_vcpu_tb_exec_inline(struct qemu_plugin_tb *block, int operation, void *number, uint64_t add);
void qemu_plugin_register_atexit_cb(uint64_t id, at_exit callback, void *data);
void qemu_plugin_outs(const char *text);

static uint64_t count;

static void translated_block(uint64_t id, struct qemu_plugin_tb *block)
{
    (void)id;
    // 0 is addition.
    qemu_plugin_register_vcpu_tb_exec_inline(block, 0, &count, qemu_plugin_tb_n_insns(block));
}

static void tell(uint64_t id, void *data)
{
    char text[40];
    (void)id;
    (void)data;
    snprintf(text, sizeof text, "%" PRIu64 " instructions\n", count);
    qemu_plugin_outs(text);
}

int qemu_plugin_install(uint64_t id, const void *info, int argc, char **argv)
{
    (void)info;
    (void)argc;
    (void)argv;
    qemu_plugin_register_vcpu_tb_trans_cb(id, translated_block);
    qemu_plugin_register_atexit_cb(id, tell, NULL);
    return 0;
}
