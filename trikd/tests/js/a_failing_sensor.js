try { brick.sensor(A2).read(); } catch (e) { print(e.name, ": ", e.message); }
brick.sensor(A2).read();
//< sensors/A2/value fast
//< sensors/A2/fault device: cable is off
//> Error: sensors/A2: invalid data (device: cable is off)
//! Line 2: Error: sensors/A2: invalid data (device: cable is off)
//! <global>() at 2
