// The package as the studio declares it, and as it is; it is compiled and never run.
import * as built from 'trik-studio-web';
import type * as taken from './taken';

export const same: typeof taken = built;
