
/* Runs a converter with its readings: program ROWS. */
int main(int count, char **arguments)
{
    FILE *file = fopen(arguments[count - 1], "r");
    struct state *s = NULL;
    trikfs_open_info info = { .size = sizeof info, .input_size = INPUT_SIZE, .output_size = OUTPUT_SIZE };
    int row[8];
    uint32_t us = 0;
    if (file == NULL || opened(&info, (void **)&s) != TRIKFS_OK) {
        return 1;
    }
    while (fscanf(file, "%d %d %d %d %d %d %d %d", &row[0], &row[1], &row[2], &row[3], &row[4], &row[5], &row[6], &row[7]) == 8) {
        uint8_t in[INPUT_SIZE + 1], out[OUTPUT_SIZE + 1];
        uint8_t *at = in;
        int code;
#define PUT(count, from) memcpy(at, &row[from], (count) * sizeof(int32_t)), at += (count) * sizeof(int32_t);
        INPUTS
        memcpy(at, &us, sizeof us);
        us = 20000;
        code = convert(s, in, INPUT_SIZE, out, OUTPUT_SIZE);
        if (code != TRIKFS_OK && code != TRIKFS_CONSUMED) {
            printf("fault %s\n", explain(s, code));
            break;
        }
#define NUMBER_OF(name, field) printf(name " %.17g\n", field);
#define VALUE_OF(name, field) if (field.kind == NUMBER || field.kind == TRUTH) NUMBER_OF(name, field.number)
        ALL
        printf("\n");
    }
    fclose(file);
    closed(s);
    return 0;
}
