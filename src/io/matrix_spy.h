/* matrix_spy.h -- a picture of a shadow matrix. Place: under matrix_write.c. */
#ifndef GNOI_IO_MATRIX_SPY_H
#define GNOI_IO_MATRIX_SPY_H

#include <gnomon/gnomon_io.h>

/* Writes a square PNG: rows (casters) downwards, columns (receivers) to the right. Small matrices are magnified, large ones gathered
 * into at most `side` cells each way, darker where there are more ones; own shadow is red. */
gno_status gnoi_matrix_spy(gno_matrix *matrix, const char *path, int side);

#endif
