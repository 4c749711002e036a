/* fetch.h -- asks for a cache line before it is needed; a hint without effect on results. Place: base; knows nothing.
 * GCC takes a function that does nothing else for one without effect and drops its calls: it belongs into loops that do something. */
#ifndef GNOI_BASE_FETCH_H
#define GNOI_BASE_FETCH_H

#if defined(__GNUC__)
#define FETCH(address) __builtin_prefetch(address)
#else
#define FETCH(address) (void)(address)
#endif

#endif
