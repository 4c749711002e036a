/* interrupt.h -- Ctrl-C and its like as a flag that the work asks for.
 *
 * Place: under the commands. Signals are caught only while there is something to leave tidy; a second one ends the program
 * at once.
 */
#ifndef GNOMON_CLI_INTERRUPT_H
#define GNOMON_CLI_INTERRUPT_H

void interrupt_catch(void);
void interrupt_release(void);

/* The signal that came while caught, or 0. */
int interrupt_signal(void);

#endif
