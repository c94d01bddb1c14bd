/* GKlib includes this header everywhere and uses it on other systems only; MinGW has none. */
