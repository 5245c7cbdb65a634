try { brick.getStillImage(); } catch (e) { print(e.message); }
getPhoto();
//> TREE/camera/picture/bin_data: No such file or directory (os error 2)
//! Line 2: Error: TREE/camera/picture/bin_data: No such file or directory (os error 2)
//! <global>() at 2
