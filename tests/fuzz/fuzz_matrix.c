/* fuzz_matrix.c -- bytes as a Matrix Market file. What is read has sorted columns in range. */
#include "fuzz/fuzz.h"

#include <gnomon/gnomon_io.h>
#include <gnomon/gnomon_matrix.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    gno_context *context = fuzz_context();
    gno_matrix *matrix = NULL;
    gno_status status = gno_matrix_load(context, fuzz_file("fuzz.mtx", data, size), &matrix);
    fuzz_expect((status == GNO_OK) == (matrix != NULL), "a matrix exactly when all is well");
    fuzz_expect(status == GNO_OK || gno_context_message(context)[0] != '\0', "a message");
    for (size_t i = 0; matrix != NULL && i < gno_matrix_size(matrix) && i < 1000; i++) {
        gno_matrix_column column;
        fuzz_expect(gno_matrix_get_column(matrix, i, &column) == GNO_OK, "a column");
        for (size_t k = 0; k < column.count; k++) {
            fuzz_expect(column.casters[k] < gno_matrix_size(matrix) && (k == 0 || column.casters[k - 1] < column.casters[k]), "order");
        }
    }
    gno_matrix_destroy(matrix);
    gno_context_destroy(context);
    return 0;
}
