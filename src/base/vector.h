/* vector.h -- the same C compiled for wider vectors too, chosen when the program starts; plain IEEE arithmetic in all of them, so that the
 * result is the same. Place: base; knows nothing.
 */
#ifndef GNOI_BASE_VECTOR_H
#define GNOI_BASE_VECTOR_H

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) /* the choice comes too early for sanitizers */
#define VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define VECTOR_CLONES
#endif

#endif
