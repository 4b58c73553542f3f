C     FORTRAN 77: A SCENE BY CALLS, SAVED HALF WAY AND TAKEN UP AGAIN.
C     THE HISTORIES MUST BE THE SAME TO THE BIT; PRINTS WHAT IS WRONG.
      PROGRAM SCENES
      INTEGER*8 ISIM(2)
      INTEGER IERR, I, N, K, NROWS(2), MAXN
      PARAMETER (MAXN = 5000)
      DOUBLE PRECISION T(MAXN, 2), V(6, MAXN, 2), EKIN, ESTR, EK2, ES2
      CHARACTER*200 TEXT
      DO 10 I = 1, 2
         CALL MAKE(ISIM(I), IERR)
         IF (IERR .NE. 0) GOTO 900
   10 CONTINUE
C     A REFUSED CALL SAYS WHY, AND CHANGES NOTHING.
      CALL SLSETI(ISIM(1), 'method%degree', 9, IERR)
      CALL SLLAST(ISIM(1), TEXT)
      IF (IERR .EQ. 0 .OR. INDEX(TEXT, 'degree') .EQ. 0) GOTO 900
      CALL SLSTEP(ISIM(1), 20, IERR)
      IF (IERR .NE. 0) GOTO 900
      CALL SLENER(ISIM(1), EKIN, ESTR, IERR)
      IF (IERR .NE. 0 .OR. EKIN .LE. 0 .OR. ESTR .LE. 0) GOTO 900
      CALL SLSAVE(ISIM(1), 'legacy.h5', IERR)
      IF (IERR .NE. 0) GOTO 900
      CALL SLREST(ISIM(2), 'legacy.h5', IERR)
      IF (IERR .NE. 0) GOTO 900
      CALL SLENER(ISIM(2), EK2, ES2, IERR)
      IF (IERR .NE. 0 .OR. EK2 .NE. EKIN .OR. ES2 .NE. ESTR) GOTO 900
      DO 20 I = 1, 2
         CALL SLFINI(ISIM(I), IERR)
         IF (IERR .NE. 0) GOTO 900
         CALL SLHIST(ISIM(I), 'r', MAXN, NROWS(I), T(1, I), V(1, 1, I),
     +               IERR)
         IF (IERR .NE. 0) GOTO 900
   20 CONTINUE
      IF (NROWS(1) .NE. NROWS(2) .OR. NROWS(1) .LT. 22) GOTO 900
      DO 30 I = 1, NROWS(1)
         IF (T(I, 1) .NE. T(I, 2)) GOTO 900
         DO 30 K = 1, 6
            IF (V(K, I, 1) .NE. V(K, I, 2)) GOTO 900
   30 CONTINUE
      CALL SLCLOS(ISIM(1))
      CALL SLCLOS(ISIM(2))
      STOP
  900 CALL SLMESG(ISIM(1), TEXT)
      WRITE (*, *) IERR, TEXT
      CALL SLMESG(ISIM(2), TEXT)
      WRITE (*, *) TEXT
      STOP 1
      END

      SUBROUTINE MAKE(ISIM, IERR)
      INTEGER*8 ISIM
      INTEGER IERR, N
      DOUBLE PRECISION LOW(2), HIGH(2), PLACE(2), DOWN(2)
      DATA LOW /0D0, 0D0/, HIGH /4D0, 2D0/, PLACE /3D0, 1D0/
      DATA DOWN /0D0, 1D0/
      CALL SLNEW('legacy', ISIM, IERR)
      CALL SLSETI(ISIM, 'scene%dimension', 2, IERR)
      CALL SLSETR(ISIM, 'scene%end_time', 1, 3D0, IERR)
      CALL SLSETL(ISIM, 'output%plots', .FALSE., IERR)
      CALL SLADD(ISIM, 'material', N, IERR)
      CALL SLSETC(ISIM, 'material%name', 'rock', IERR)
      CALL SLSETR(ISIM, 'material%density', 1, 1D0, IERR)
      CALL SLSETR(ISIM, 'material%lambda', 1, 1D0, IERR)
      CALL SLSETR(ISIM, 'material%mu', 1, 1D0, IERR)
      CALL SLADD(ISIM, 'body', N, IERR)
      CALL SLSETC(ISIM, 'body%material', 'rock', IERR)
      CALL SLSETR(ISIM, 'body%low', 2, LOW, IERR)
      CALL SLSETR(ISIM, 'body%high', 2, HIGH, IERR)
      CALL SLSETR(ISIM, 'body%spacing', 1, 0.25D0, IERR)
      CALL SLADD(ISIM, 'load', N, IERR)
      CALL SLSETC(ISIM, 'load%face', 'y-', IERR)
      CALL SLSETC(ISIM, 'load%shape', 'face', IERR)
      CALL SLSETR(ISIM, 'load%direction', 2, DOWN, IERR)
      CALL SLSETC(ISIM, 'load%history', 'triangle', IERR)
      CALL SLSETR(ISIM, 'load%duration', 1, 1D0, IERR)
      CALL SLADD(ISIM, 'receiver', N, IERR)
      IF (N .NE. 1) IERR = -1
      CALL SLSETC(ISIM, 'receiver(1)%name', 'r', IERR)
      CALL SLSETR(ISIM, 'receiver(1)%position', 2, PLACE, IERR)
      END
