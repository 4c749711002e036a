/* pages.h -- fresh memory that is about to be written is asked for in one piece, not page by page as each is first touched. A hint without
 * effect on results. Place: base; knows nothing.
 */
#ifndef GNOI_BASE_PAGES_H
#define GNOI_BASE_PAGES_H

#include <stddef.h>

/* `bytes` of memory from `block` on, all of which will be written soon. Thread safe. */
void gnoi_pages_ready(void *block, size_t bytes);

#endif
